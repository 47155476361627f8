import { View } from "../view/view";
import { Toasts } from "../ui/toast";
import { BottomDock, Rail, SideDock } from "./dock";
import { TopBar } from "./top-bar";

/** The page: a bar on top, the picture, the open panels and the rail that opens them. */
export function App() {
  return (
    <div class="page">
      <TopBar />
      <main class="middle">
        <div class="stage">
          <View />
          <BottomDock />
        </div>
        <SideDock />
        <Rail />
      </main>
      <Toasts />
    </div>
  );
}
