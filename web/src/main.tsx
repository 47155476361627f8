import { render } from "preact";
import { App } from "./shell/app";
import { applyTheme } from "./shell/theme";
import { connect } from "./state/connection";
import "./styles/tokens.css";
import "./styles/base.css";
import "./styles/controls.css";
import "./styles/shell.css";
import "./styles/view.css";

applyTheme();
connect();
render(<App />, document.getElementById("page")!);
