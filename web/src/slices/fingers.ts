import { crosshair, setCrosshair } from "../state/crosshair";
import { setWindow, sliceWindow } from "./state";

/** Fingers on one pane. One does what the mouse does; a second takes that back, and from then on two of them move and
 * zoom what the panes show, until all are lifted. */

/** What two fingers did [CSS px]: their middle went by (dx, dy) to (x, y) of the window, and what is between them is to
 * be `factor` times as large. */
export interface TwoFingerMove {
  dx: number;
  dy: number;
  x: number;
  y: number;
  factor: number;
}

export interface Fingers {
  /** A finger comes down; `alone` starts what the first one does and returns what ends that. */
  down(event: PointerEvent, alone: (event: PointerEvent) => () => void): void;
  /** What a move of a finger is of two; null where there are not two. */
  move(event: PointerEvent): TwoFingerMove | null;
  up(event: PointerEvent): void;
}

/** Nearer together they tell no ratio. */
const kLeastSpan_px = 20;
/** Fingers that only move what is seen do not keep their distance exactly. */
const kZoomBegins_px = 16;

export function fingersOnPane(): Fingers {
  const places = new Map<number, { x: number; y: number }>();
  let takeBack: (() => void) | null = null;
  /** Between the two when the last came down; null once they zoom. */
  let firstSpan: number | null = null;

  const factorOf = (was: number, is: number) => {
    if (Math.min(was, is) < kLeastSpan_px) return 1;
    if (firstSpan === null) return is / was;
    if (Math.abs(is - firstSpan) < kZoomBegins_px) return 1;
    const factor = is / Math.max(firstSpan, kLeastSpan_px);
    firstSpan = null;
    return factor;
  };

  const begin = (event: PointerEvent, alone: (event: PointerEvent) => () => void) => {
    const [cross, window] = [crosshair.peek(), sliceWindow.peek()];
    const letGo = alone(event);
    takeBack = () => {
      letGo();
      if (cross) setCrosshair(cross);
      if (sliceWindow.peek() !== window) setWindow(window);
    };
  };

  return {
    down(event, alone) {
      if (event.isPrimary) places.clear();
      places.set(event.pointerId, { x: event.clientX, y: event.clientY });
      if (places.size === 1) return begin(event, alone);
      takeBack?.();
      takeBack = null;
      const [a, b] = [...places.values()];
      firstSpan = Math.hypot(a!.x - b!.x, a!.y - b!.y);
      (event.currentTarget as Element).setPointerCapture(event.pointerId);
      event.preventDefault();
    },
    move(event) {
      const before = places.get(event.pointerId);
      if (!before) return null;
      const now = { x: event.clientX, y: event.clientY };
      places.set(event.pointerId, now);
      const other = [...places].find(([id]) => id !== event.pointerId)?.[1];
      if (!other || places.size !== 2) return null;
      const span = (at: typeof now) => Math.hypot(at.x - other.x, at.y - other.y);
      return {
        dx: (now.x - before.x) / 2,
        dy: (now.y - before.y) / 2,
        x: (now.x + other.x) / 2,
        y: (now.y + other.y) / 2,
        factor: factorOf(span(before), span(now)),
      };
    },
    up(event) {
      places.delete(event.pointerId);
      if (places.size === 0) takeBack = null;
    },
  };
}
