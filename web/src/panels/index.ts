import type { ComponentType } from "preact";
import "../styles/panels.css";
import type { IconName } from "../ui/icons";
import { TransferPanel } from "./transfer/panel";

/** The panels, in the order of the rail at the right edge. One is open beside the picture at a time, and one below it;
 * a panel's component exists only while it is open. It reads state/, changes the scene by edit(), and is made of ui/. */
export interface Panel {
  /** Short and lasting: remembered in the browser. */
  id: string;
  title: string;
  icon: IconName;
  component: ComponentType;
  /** Side: beside the picture, 320 px wide, scrolls. Bottom: below it, over its whole width, 200 px high. */
  place: "side" | "bottom";
}

export const panels: readonly Panel[] = [
  { id: "transfer", title: "Transfer function", icon: "curve", component: TransferPanel, place: "side" },
];
