import { useEffect } from "preact/hooks";
import { Toasts } from "../ui/toast";
import { StatusBar } from "../view/status-bar";
import { View } from "../view/view";
import { BottomDock, Rail, SideDock } from "./dock";
import { DropTarget } from "./drop";
import { Help } from "./help";
import { ConnectionBanner, Loading, OpenFailed } from "./loading";
import { OpenDialog, OpeningScreen } from "./opening";
import { listenToKeys } from "./shortcuts";
import { TopBar } from "./top-bar";

/** The page: a bar on top, the picture, the open panels and the rail that opens them. */
export function App() {
  useEffect(listenToKeys, []);
  return (
    <div class="page">
      <TopBar />
      <main class="middle">
        <div class="stage">
          <div class="canvas-area">
            <View />
            <OpeningScreen />
            <div class="cards">
              <ConnectionBanner />
              <Loading />
              <OpenFailed />
            </div>
          </div>
          <StatusBar />
          <BottomDock />
        </div>
        <SideDock />
        <Rail />
      </main>
      <OpenDialog />
      <Help />
      <Toasts />
      <DropTarget />
    </div>
  );
}
