import type { ComponentType } from "preact";
import "../styles/panels.css";
import type { IconName } from "../ui/icons";
import { AnimationPanel } from "./animation/panel";
import { CameraPanel } from "./camera";
import { ClipPanel } from "./clip";
import { LabelsPanel } from "./labels/panel";
import { LightsPanel } from "./lights/panel";
import { MaterialPanel } from "./material";
import { RenderPanel } from "./render";
import { TransferPanel } from "./transfer/panel";
import { VisibilityPanel } from "./visibility/panel";

/** The panels, in the order of the rail at the right edge. One is open beside the picture at a time, and one below it;
 * a panel's component exists only while it is open. It reads state/, changes the scene by edit(), and is made of ui/. */
export interface Panel {
  /** Short and lasting: remembered in the browser. */
  id: string;
  title: string;
  icon: IconName;
  component: ComponentType;
  /** Side: beside the picture, 320 px wide, scrolls. Bottom: below it, over its whole width, as high as it needs. */
  place: "side" | "bottom";
}

export const panels: readonly Panel[] = [
  { id: "transfer", title: "Transfer function", icon: "curve", component: TransferPanel, place: "side" },
  { id: "labels", title: "Labels", icon: "labels", component: LabelsPanel, place: "side" },
  { id: "material", title: "Material", icon: "material", component: MaterialPanel, place: "side" },
  { id: "lights", title: "Lights and background", icon: "light", component: LightsPanel, place: "side" },
  { id: "clip", title: "Clip box", icon: "clip", component: ClipPanel, place: "side" },
  { id: "visibility", title: "Keep in view", icon: "eye", component: VisibilityPanel, place: "side" },
  { id: "camera", title: "Camera", icon: "camera", component: CameraPanel, place: "side" },
  { id: "render", title: "Picture and rendering", icon: "settings", component: RenderPanel, place: "side" },
  { id: "animation", title: "Animation", icon: "film", component: AnimationPanel, place: "bottom" },
];
