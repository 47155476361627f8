import { canvasOf, planes, pointOf, type PaneView, type Plane, type PlaneLayout } from "../model/slice";
import { planesOn_mm, sliceSteps } from "../model/slice-steps";
import { dragWindow } from "../model/window";
import { crosshair, setCrosshair } from "../state/crosshair";
import type { Vec3 } from "../state/scene-types";
import type { VolumeFacts } from "../state/volume";
import { startDrag } from "../ui/drag";
import { measuring, removeLast, setEnd, type MeasuringPane } from "../view/distances";
import { cursorStep, hideKeyCursor, moveKeyCursor, setEndAtKeyCursor } from "../view/key-cursor";
import { pointAt } from "../view/probing";
import { type Fingers } from "./fingers";
import { dragTool, panSlices, paneView, resetSlices, setWindow, sliceWindow, zoomSlices } from "./state";

/** What pointers, wheel and keys do on a slice. */

/** Moves the crosshair into the plane at `mm`. */
export function goToSlice(layout: PlaneLayout, mm: number): void {
  const now = crosshair.peek();
  if (now) setCrosshair(now.map((x, i) => (i === layout.normal ? mm : x)) as unknown as Vec3);
}

/** How far from the plane ends of distances are still shown: the smallest side of a voxel, or half a slice, so that
 * every end is in a slice. */
const reach_mm = (facts: VolumeFacts, layout: PlaneLayout): number =>
  Math.max(Math.min(...facts.spacing_mm), sliceSteps(facts, layout.normal).step_mm / 2) * (1 + 1e-6);

/** The pane that shows `plane` at `mm`, as distances are set in it. */
export function slicePane(plane: Plane, pane: PaneView, mm: number, facts: VolumeFacts): MeasuringPane {
  const layout = planes[plane];
  const near_mm = reach_mm(facts, layout);
  const [x, y] = canvasOf(layout, pane, crosshair.peek() ?? pane.center_mm);
  const { width, height } = pane;
  const seen = x >= 0 && x < width && y >= 0 && y < height;
  return {
    name: plane,
    width,
    height,
    start: seen ? { x, y } : { x: width / 2, y: height / 2 },
    place: (p) => {
      if (Math.abs(p[layout.normal] - mm) > near_mm) return null;
      const [left, top] = canvasOf(layout, pane, p);
      return { x: left, y: top };
    },
    at: (left, top) => pointOf(layout, pane, mm, left, top),
    under: (left, top) => () => pointOf(layout, paneView(pane), crosshair.value?.[layout.normal] ?? mm, left, top),
  };
}

const kZoomOfKey = 1.25;
/** Of a pixel of the wheel with Ctrl, which is also what a pinch on a touchpad comes as. */
const kZoomOfWheel = 0.006;
const kMostWheel_px = 100;

/** Handlers of the pane that shows `plane` at `mm` as `pane` has it, with the fingers on it. */
export function sliceInput(plane: Plane, pane: PaneView, mm: number, facts: VolumeFacts, fingers: Fingers) {
  const layout = planes[plane];
  // From where it is by now: several turns of the wheel may come before the next one is drawn.
  const go = (by: number) =>
    goToSlice(layout, planesOn_mm(sliceSteps(facts, layout.normal), crosshair.peek()?.[layout.normal] ?? mm, by));
  const pointOfEvent = (event: MouseEvent): Vec3 => {
    const box = (event.currentTarget as Element).getBoundingClientRect();
    return pointOf(layout, pane, mm, event.clientX - box.left, event.clientY - box.top);
  };

  const dragLevel = (event: PointerEvent) => {
    const from = sliceWindow.peek();
    const extent = facts.range[1] - facts.range[0];
    return startDrag(event, { move: ({ dx, dy }) => setWindow(dragWindow(from, dx, dy, extent)) }, [0, 2]);
  };
  const dragPane = (event: PointerEvent) =>
    startDrag(event, { move: ({ stepX, stepY }) => panSlices(layout, stepX, stepY) }, [0, 1]);
  const dragCrosshair = (event: PointerEvent) => {
    setCrosshair(pointOfEvent(event));
    return startDrag(event, { move: ({ event: moved }) => setCrosshair(pointOfEvent(moved)) });
  };

  const clickEnd = (event: PointerEvent) => {
    const box = (event.currentTarget as Element).getBoundingClientRect();
    return startDrag(event, {
      move: () => undefined,
      click: ({ event: up }) =>
        void setEnd(slicePane(plane, pane, mm, facts), up.clientX - box.left, up.clientY - box.top),
    });
  };

  const startDragOf = (event: PointerEvent) => {
    if (event.button === 1 || (event.button === 0 && event.shiftKey)) return dragPane(event);
    if (event.button === 2 || (event.button === 0 && dragTool.peek() === "window")) return dragLevel(event);
    if (event.button === 0 && measuring.peek()) return clickEnd(event);
    return event.button === 0 ? dragCrosshair(event) : () => undefined;
  };
  const down = (event: PointerEvent) => {
    if (event.target instanceof Element && event.target.closest(".handle")) return;
    if (event.pointerType === "touch") fingers.down(event, startDragOf);
    else startDragOf(event);
  };

  const move = (event: PointerEvent) => {
    const moved = fingers.move(event);
    if (!moved) return hover(event);
    panSlices(layout, moved.dx, moved.dy);
    const box = (event.currentTarget as Element).getBoundingClientRect();
    const about = pointOf(layout, paneView(pane), mm, moved.x - box.left, moved.y - box.top);
    if (moved.factor !== 1) zoomSlices(moved.factor, about);
  };

  const hover = (event: PointerEvent) => {
    if (event.movementX || event.movementY) hideKeyCursor();
    const box = (event.currentTarget as Element).getBoundingClientRect();
    const under = slicePane(plane, pane, mm, facts).under(event.clientX - box.left, event.clientY - box.top);
    pointAt(event.buttons === 0 ? under : null);
  };
  const up = (event: PointerEvent) => {
    fingers.up(event);
    // After a drag it rests where it is let go.
    if (event.pointerType === "mouse") hover(event);
  };

  const wheel = (event: WheelEvent) => {
    event.preventDefault();
    // Shift makes some browsers turn the wheel sideways.
    const turn = event.deltaY || event.deltaX;
    if (event.ctrlKey || event.metaKey) {
      const pixels = turn * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 : 1);
      const kept = Math.max(-kMostWheel_px, Math.min(kMostWheel_px, pixels));
      zoomSlices(Math.exp(-kept * kZoomOfWheel), pointOfEvent(event));
    } else if (turn) go(-Math.sign(turn) * (event.shiftKey ? 10 : 1));
  };

  /** What keys do while distances are measured. */
  const measure = (event: KeyboardEvent): boolean => {
    const area = slicePane(plane, pane, mm, facts);
    const way = cursorStep(event.key, event.shiftKey);
    if (way) moveKeyCursor(area, ...way);
    else if (event.key === "Enter") setEndAtKeyCursor(area);
    else if (event.key === "Delete" || event.key === "Backspace") removeLast();
    else return false;
    return true;
  };
  const act = (event: KeyboardEvent): boolean => {
    const steps = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
    const factor = { "+": kZoomOfKey, "=": kZoomOfKey, "-": 1 / kZoomOfKey }[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    if (measuring.peek() && event.target === event.currentTarget && measure(event)) return true;
    if (steps) go(steps);
    else if (factor) zoomSlices(factor, crosshair.peek() ?? pane.center_mm);
    else if (event.key === "f") resetSlices();
    else return false;
    return true;
  };
  const keyDown = (event: KeyboardEvent) => {
    if (!act(event)) return;
    event.preventDefault();
    event.stopPropagation();
  };

  return { down, move, up, wheel, keyDown };
}
