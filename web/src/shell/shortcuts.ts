import { newGesture, redo, scene, undo } from "../state/scene";
import {
  axisViews,
  fitView,
  lookFrom,
  orbitBy,
  panByPixels,
  rollBy,
  toggleProjection,
  zoomBy,
} from "../view/camera-control";
import { measuring, removeLast } from "../view/distances";
import { cursorStep, moveKeyCursor, setEndAtKeyCursor } from "../view/key-cursor";
import { picturePane } from "../view/measure";
import { endTool, toggleClip, toggleLights, toggleMeasuring, toggleSplit, toolInUse } from "../view/toolbar";
import { helpShown, toggleFullscreen, toggleSlices } from "./page-state";
import { copyLink, savePng } from "./keep";
import { openDialog } from "./opening";

/** All keys of the page, for the listener and for the help. */

export interface Shortcut {
  /** As the help writes them. */
  keys: readonly string[];
  what: string;
  group: "Camera" | "Tools" | "Page";
  matches(event: KeyboardEvent): boolean;
  /** `gesture` is the same while the key is held or pressed again soon. */
  run(event: KeyboardEvent, gesture: string): void;
  /** Works only while the picture (or nothing) has the focus. */
  inView?: boolean;
}

/** AltGr is how some keyboards write brackets. */
const plain = (event: KeyboardEvent) =>
  event.getModifierState("AltGraph") || (!event.ctrlKey && !event.metaKey && !event.altKey);
const key = (name: string) => (event: KeyboardEvent) => event.key.toLowerCase() === name && plain(event);
const control = (name: string, shift: boolean) => (event: KeyboardEvent) =>
  event.key.toLowerCase() === name && (event.ctrlKey || event.metaKey) && event.shiftKey === shift;
/** What Enter presses itself. */
const isControl = (target: EventTarget | null) =>
  target instanceof Element && target.closest("button, a, [role=button], [role=slider]") !== null;
const arrows: Record<string, readonly [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
const isArrow = (event: KeyboardEvent) => event.key in arrows && plain(event);

const kOrbit_deg = 5;
const kPan_px = 24;
const kZoom = 1.1;
const kRoll_deg = 5;
/** Presses of one key that follow this soon are one step of undo. */
const kTogether_ms = 800;

export const shortcuts: readonly Shortcut[] = [
  { keys: ["M"], what: "Measure distances", group: "Tools", matches: key("m"), run: toggleMeasuring },
  {
    keys: ["Arrows"],
    what: "While measuring: move the cursor, with Shift ten times as far",
    group: "Tools",
    inView: true,
    matches: (event) => measuring.value && isArrow(event),
    run: ({ key: name, shiftKey }) => moveKeyCursor(picturePane(), ...cursorStep(name, shiftKey)!),
  },
  {
    keys: ["Enter"],
    what: "While measuring: set an end at the cursor",
    group: "Tools",
    inView: true,
    matches: (event) => measuring.value && key("enter")(event) && !isControl(event.target),
    run: () => setEndAtKeyCursor(picturePane()),
  },
  {
    keys: ["Delete"],
    what: "Delete the last distance",
    group: "Tools",
    inView: true,
    matches: (event) => measuring.value && (key("delete")(event) || key("backspace")(event)),
    run: removeLast,
  },
  {
    keys: ["Arrows"],
    what: "Orbit",
    group: "Camera",
    inView: true,
    matches: (event) => isArrow(event) && !event.shiftKey,
    run: ({ key: name }, gesture) => orbitBy(arrows[name]![0] * kOrbit_deg, arrows[name]![1] * kOrbit_deg, gesture),
  },
  {
    keys: ["Shift", "Arrows"],
    what: "Move sideways",
    group: "Camera",
    inView: true,
    matches: (event) => isArrow(event) && event.shiftKey,
    run: ({ key: name }, gesture) => panByPixels(arrows[name]![0] * kPan_px, -arrows[name]![1] * kPan_px, gesture),
  },
  {
    keys: ["+", "-"],
    what: "Zoom",
    group: "Camera",
    matches: (event) => ["+", "=", "-"].some((name) => key(name)(event)),
    run: (event, gesture) => zoomBy(event.key === "-" ? 1 / kZoom : kZoom, gesture),
  },
  {
    keys: ["[", "]"],
    what: "Roll",
    group: "Camera",
    matches: (event) => key("[")(event) || key("]")(event),
    run: (event, gesture) => rollBy(event.key === "]" ? kRoll_deg : -kRoll_deg, gesture),
  },
  {
    keys: ["1", "...", "6"],
    what: "View from anterior, posterior, left, right, superior, inferior",
    group: "Camera",
    matches: (event) => axisViews.some((_, i) => key(String(i + 1))(event)),
    run: (event) => {
      const { azimuth_deg, elevation_deg } = axisViews[Number(event.key) - 1]!;
      lookFrom(azimuth_deg, elevation_deg);
    },
  },
  {
    keys: ["F"],
    what: "Fit the volume into the view",
    group: "Camera",
    matches: (event) => key("f")(event) && !event.shiftKey,
    run: fitView,
  },
  {
    keys: ["O"],
    what: "Perspective or parallel projection",
    group: "Camera",
    matches: key("o"),
    run: toggleProjection,
  },
  {
    keys: ["Esc"],
    what: "End the tool",
    group: "Tools",
    matches: (event) => toolInUse() && key("escape")(event),
    run: endTool,
  },
  { keys: ["L"], what: "Light handles", group: "Tools", matches: key("l"), run: toggleLights },
  { keys: ["C"], what: "Clip handles", group: "Tools", matches: key("c"), run: toggleClip },
  {
    keys: ["D"],
    what: "Compare with the picture before the denoiser",
    group: "Tools",
    matches: key("d"),
    run: toggleSplit,
  },
  { keys: ["S"], what: "Slices beside the picture", group: "Tools", matches: key("s"), run: toggleSlices },
  { keys: ["Ctrl", "Z"], what: "Undo", group: "Page", matches: control("z", false), run: undo },
  {
    keys: ["Ctrl", "Shift", "Z"],
    what: "Redo",
    group: "Page",
    matches: (event) => control("z", true)(event) || control("y", false)(event),
    run: redo,
  },
  {
    keys: ["Ctrl", "O"],
    what: "Open a volume or scene",
    group: "Page",
    matches: control("o", false),
    run: () => (openDialog.value = true),
  },
  { keys: ["Ctrl", "S"], what: "Save the picture (PNG)", group: "Page", matches: control("s", false), run: savePng },
  {
    keys: ["Ctrl", "Shift", "L"],
    what: "Copy a link to this scene",
    group: "Page",
    matches: control("l", true),
    run: copyLink,
  },
  {
    keys: ["Shift", "F"],
    what: "Full screen",
    group: "Page",
    matches: (event) => key("f")(event) && event.shiftKey,
    run: toggleFullscreen,
  },
  { keys: ["?"], what: "This help", group: "Page", matches: key("?"), run: () => (helpShown.value = !helpShown.value) },
];

/** What pointers do, for the help. */
export const pointerHelp: readonly { keys: string; what: string }[] = [
  { keys: "Drag, one finger", what: "Orbit" },
  { keys: "Right or middle drag, Shift + drag, two fingers", what: "Move sideways" },
  { keys: "Wheel, pinch, Ctrl + drag", what: "Zoom" },
  { keys: "Alt + drag, twist", what: "Roll" },
  { keys: "Double click, double tap", what: "Orbit around this point" },
  { keys: "Click, while measuring", what: "An end of a distance, in the picture or a slice" },
  { keys: "Arrows and Delete on an end of a distance", what: "Move it; delete the distance" },
  { keys: "Click, beside slices", what: "Slices through this point" },
  { keys: "Wheel, arrows, Page Up and Down on a slice", what: "Through the slices" },
  { keys: "Ctrl + wheel, pinch, + and - on a slice", what: "Zoom of all slices; F takes it back" },
  { keys: "Middle, Shift + or two-finger drag on a slice", what: "Move all slices" },
  { keys: "Right drag on a slice", what: "Window and level" },
  { keys: "Wheel or Shift + drag on a light", what: "Its distance" },
];

function takesText(target: EventTarget | null): boolean {
  if (!(target instanceof HTMLElement)) return false;
  if (target instanceof HTMLInputElement) return !["checkbox", "radio", "button", "color"].includes(target.type);
  return target.isContentEditable || target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}

/** Listens to the page's keys; returns what ends that. */
export function listenToKeys(): () => void {
  let last = { gesture: "", shortcut: shortcuts[0], time_ms: -Infinity };
  const down = (event: KeyboardEvent) => {
    if (event.defaultPrevented || takesText(event.target) || document.querySelector("dialog[open]")) return;
    const focus = document.activeElement;
    const inView = !focus || focus === document.body || focus.closest(".view") !== null;
    const shortcut = shortcuts.find((one) => (inView || !one.inView) && one.matches(event));
    if (!shortcut || (!scene.peek() && shortcut.group !== "Page")) return;
    event.preventDefault();
    const goesOn = shortcut === last.shortcut && event.timeStamp - last.time_ms < kTogether_ms;
    last = { gesture: goesOn ? last.gesture : newGesture("keys"), shortcut, time_ms: event.timeStamp };
    shortcut.run(event, last.gesture);
  };
  addEventListener("keydown", down);
  return () => removeEventListener("keydown", down);
}
