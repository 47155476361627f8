import { render } from "preact";
import { App } from "./shell/app";
import { openLinkedScene } from "./shell/linked-scene";
import { announceTrouble } from "./shell/notices";
import { keepOnePanel } from "./shell/small-window";
import { applyTheme } from "./shell/theme";
import { connect, on } from "./state/connection";
import { flushEdits } from "./state/scene";
import "./styles/tokens.css";
import "./styles/base.css";
import "./styles/controls.css";
import "./styles/shell.css";
import "./styles/opening.css";
import "./styles/view.css";
import "./styles/small.css";
import "./styles/forced-colors.css";

applyTheme();
announceTrouble();
keepOnePanel();
render(<App />, document.getElementById("page")!);

// A link to a scene is opened once the server is there, also when it is put into the address of an open page.
on("hello", () => void openLinkedScene());
addEventListener("hashchange", () => void openLinkedScene());
addEventListener("pagehide", flushEdits);
connect();
