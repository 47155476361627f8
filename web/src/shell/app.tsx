import { useEffect } from "preact/hooks";
import { SliceBar, SlicePlanes } from "../slices/slices";
import { layout } from "../state/preferences";
import { scene } from "../state/scene";
import { volume } from "../state/volume";
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
  const slicesShown = layout.value === "slices" && scene.value !== null && volume.value !== null;
  const open = volume.value?.name;
  useEffect(() => {
    document.title = open ? `${open} - voxlume` : "voxlume";
  }, [open]);
  return (
    <div class="page">
      <TopBar />
      <main class="middle">
        <div class="stage">
          {slicesShown && <SliceBar />}
          <div class={slicesShown ? "canvas-area with-slices" : "canvas-area"}>
            {slicesShown && <SlicePlanes />}
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
