import { effect, signal, type ReadonlySignal } from "@preact/signals";
import { formatPosition } from "../geometry/length";
import { lengthScale } from "../state/lengths";
import { begun, lengthOf, measuring, sayAtRest, setEnd, type MeasuringPane } from "./distances";
import { pointAt, pointed } from "./probing";

/** The cursor that keys move while distances are measured: a place of one pane [CSS px]. */

const cursor = signal<{ pane: string; x: number; y: number } | null>(null);
/** Null until a key moves it, and when the pointer takes over. */
export const keyCursor: ReadonlySignal<{ pane: string; x: number; y: number } | null> = cursor;

/** From a move of the cursor until an end is set, which is said instead of the place. */
let moving = false;

function placeIn(pane: MeasuringPane): { x: number; y: number } | null {
  const now = cursor.peek();
  return now?.pane === pane.name ? now : null;
}

const ways: Record<string, readonly [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, -1],
  ArrowDown: [0, 1],
};

/** How far an arrow key moves it [CSS px right, down]; null of other keys. */
export function cursorStep(key: string, far: boolean): readonly [number, number] | null {
  const [dx, dy] = ways[key] ?? [];
  return dx === undefined || dy === undefined ? null : far ? [10 * dx, 10 * dy] : [dx, dy];
}

const clamp = (x: number, most: number) => Math.min(most - 1, Math.max(0, x));

/** Moves the cursor in a pane, where it begins at the pane's start. */
export function moveKeyCursor(pane: MeasuringPane, dx: number, dy: number): void {
  const from = placeIn(pane) ?? pane.start;
  const x = clamp(from.x + dx, pane.width);
  const y = clamp(from.y + dy, pane.height);
  cursor.value = { pane: pane.name, x, y };
  moving = true;
  pointAt(pane.under(x, y));
}

/** Sets an end at the cursor; where there is none yet, it appears. */
export function setEndAtKeyCursor(pane: MeasuringPane): void {
  const at = placeIn(pane);
  if (!at) return moveKeyCursor(pane, 0, 0);
  moving = false;
  void setEnd(pane, at.x, at.y);
}

export function hideKeyCursor(): void {
  cursor.value = null;
}

effect(() => {
  if (!measuring.value) hideKeyCursor();
});

effect(() => {
  const here = pointed.value?.position_mm;
  if (!cursor.peek() || !moving) return;
  const from = begun.peek();
  const text = !here ? "Nothing here" : from ? lengthOf({ a: from, b: here }) : formatPosition(here, lengthScale.peek());
  sayAtRest(() => (moving ? text : null));
});
