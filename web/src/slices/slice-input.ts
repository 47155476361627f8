import { planes, pointOf, type PaneView, type Plane, type PlaneLayout } from "../model/slice";
import { dragWindow } from "../model/window";
import { crosshair, setCrosshair } from "../state/crosshair";
import type { Vec3 } from "../state/scene-types";
import type { VolumeFacts } from "../state/volume";
import { startDrag } from "../ui/drag";
import { pointAt } from "../view/probing";
import { dragTool, panSlices, resetSlices, setWindow, sliceWindow, zoomSlices } from "./state";

/** What pointers, wheel and keys do on a slice. */

/** From one slice to the next: the smallest side of a voxel. */
export const sliceStep_mm = (facts: VolumeFacts): number => Math.min(...facts.spacing_mm);

/** Moves the crosshair into the plane at `mm`. */
export function goToSlice(layout: PlaneLayout, mm: number): void {
  const now = crosshair.peek();
  if (now) setCrosshair(now.map((x, i) => (i === layout.normal ? mm : x)) as unknown as Vec3);
}

const kZoomOfKey = 1.25;
/** Of a pixel of the wheel with Ctrl, which is also what a pinch on a touchpad comes as. */
const kZoomOfWheel = 0.006;
const kMostWheel_px = 100;

/** Handlers of the pane that shows `plane` at `mm` as `pane` has it. */
export function sliceInput(plane: Plane, pane: PaneView, mm: number, facts: VolumeFacts) {
  const layout = planes[plane];
  const step = sliceStep_mm(facts);
  const pointOfEvent = (event: MouseEvent): Vec3 => {
    const box = (event.currentTarget as Element).getBoundingClientRect();
    return pointOf(layout, pane, mm, event.clientX - box.left, event.clientY - box.top);
  };

  const dragLevel = (event: PointerEvent) => {
    const from = sliceWindow.peek();
    const extent = facts.range[1] - facts.range[0];
    startDrag(event, { move: ({ dx, dy }) => setWindow(dragWindow(from, dx, dy, extent)) }, [0, 2]);
  };
  const dragPane = (event: PointerEvent) =>
    startDrag(event, { move: ({ stepX, stepY }) => panSlices(layout, stepX, stepY) }, [0, 1]);
  const dragCrosshair = (event: PointerEvent) => {
    setCrosshair(pointOfEvent(event));
    startDrag(event, { move: ({ event: moved }) => setCrosshair(pointOfEvent(moved)) });
  };

  const down = (event: PointerEvent) => {
    if (event.button === 1 || (event.button === 0 && event.shiftKey)) dragPane(event);
    else if (event.button === 2 || (event.button === 0 && dragTool.peek() === "window")) dragLevel(event);
    else if (event.button === 0) dragCrosshair(event);
  };

  const hover = (event: PointerEvent) => pointAt(event.buttons === 0 ? pointOfEvent(event) : null);

  const wheel = (event: WheelEvent) => {
    event.preventDefault();
    // Shift makes some browsers turn the wheel sideways.
    const turn = event.deltaY || event.deltaX;
    if (event.ctrlKey || event.metaKey) {
      const pixels = turn * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 : 1);
      const kept = Math.max(-kMostWheel_px, Math.min(kMostWheel_px, pixels));
      zoomSlices(Math.exp(-kept * kZoomOfWheel), pointOfEvent(event));
    } else goToSlice(layout, mm - Math.sign(turn) * step * (event.shiftKey ? 10 : 1));
  };

  const act = (event: KeyboardEvent): boolean => {
    const steps = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
    const factor = { "+": kZoomOfKey, "=": kZoomOfKey, "-": 1 / kZoomOfKey }[event.key];
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    if (steps) goToSlice(layout, mm + steps * step);
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

  return { down, hover, wheel, keyDown };
}
