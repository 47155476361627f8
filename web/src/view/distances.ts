import { computed, signal, type ReadonlySignal } from "@preact/signals";
import { formatDistance, formatPosition } from "../geometry/length";
import { distance, type Vec3 } from "../geometry/vec3";
import { on } from "../state/connection";
import { lengthScale } from "../state/lengths";
import { pointerTool } from "../state/tools";
import { showToast } from "../ui/toast";
import { probeAt, type Place } from "./probing";

/** Distances between points of the anatomy. They belong to this page, not to the scene. */

export interface Measurement {
  id: number;
  a: Vec3;
  b: Vec3;
}

/** A part of the page in which distances are seen and set: the picture, or a slice. */
export interface MeasuringPane {
  name: string;
  /** [CSS px] */
  width: number;
  height: number;
  /** Where the cursor of the keys begins [CSS px]. */
  start: { x: number; y: number };
  /** Where a point is seen [CSS px]; null: not in this pane. */
  place(p: Vec3): { x: number; y: number } | null;
  /** What there is to be probed at a place of the pane. */
  at(x: number, y: number): Place;
}

export const measurements = signal<readonly Measurement[]>([]);
const first = signal<Vec3 | null>(null);
/** The first end of a distance whose second is not set yet. */
export const begun: ReadonlySignal<Vec3 | null> = first;
export const measuring = computed(() => pointerTool.value === "measure");
let count = 0;

const words = signal("");
/** What is to be read aloud of measuring. */
export const said: ReadonlySignal<string> = words;
export function say(text: string): void {
  clearTimeout(resting);
  words.value = text;
}

/** Of what goes on changing, only where it stops is said. */
const kRest_ms = 250;
let resting: ReturnType<typeof setTimeout> | undefined;
/** Says it once nothing else has been said for a while; the text is asked for then, null says nothing. */
export function sayAtRest(text: () => string | null): void {
  clearTimeout(resting);
  resting = setTimeout(() => {
    const now = text();
    if (now !== null) say(now);
  }, kRest_ms);
}

/** Distances belong to a volume; one that fails to open changes nothing. */
let opening = false;
on("status", (message) => {
  if (opening && message.stage === "ready") clearMeasurements();
  opening = message.stage === "reading" || message.stage === "preparing";
});

export function clearMeasurements(): void {
  measurements.value = [];
  first.value = null;
  say("");
}

export function removeMeasurement(id: number): void {
  measurements.value = measurements.value.filter((one) => one.id !== id);
  say("Distance deleted");
}

function dropFirst(): void {
  first.value = null;
  say("First end dropped");
}

/** Drops the first end, or the newest distance. */
export function removeLast(): void {
  const last = measurements.peek().at(-1);
  if (first.value) dropFirst();
  else if (last) removeMeasurement(last.id);
}

/** Ends the tool, or first the distance that is begun. */
export function cancelMeasuring(): void {
  if (first.value) dropFirst();
  else pointerTool.value = "navigate";
}

export const lengthOf = ({ a, b }: { a: Vec3; b: Vec3 }): string => formatDistance(distance(a, b), lengthScale.value);

const probed = async (pane: MeasuringPane, x: number, y: number) => (await probeAt(pane.at(x, y)))?.position_mm;

/** Sets an end at a place of a pane [CSS px]: the first of a distance, or its second. */
export async function setEnd(pane: MeasuringPane, x: number, y: number): Promise<void> {
  const place = await probed(pane, x, y);
  if (!place) return showToast({ text: "Nothing there to measure: choose a point of the volume." });
  if (!first.value) {
    first.value = place;
    say(`First end at ${formatPosition(place, lengthScale.peek())}`);
    return;
  }
  const added = { id: ++count, a: first.value, b: place };
  measurements.value = [...measurements.value, added];
  first.value = null;
  say(`Distance ${lengthOf(added)}`);
}

/** Moves an end to a place of a pane [CSS px]; false where there is nothing. */
export async function moveEnd(id: number, end: "a" | "b", pane: MeasuringPane, x: number, y: number): Promise<boolean> {
  const place = await probed(pane, x, y);
  if (place) measurements.value = measurements.value.map((one) => (one.id === id ? { ...one, [end]: place } : one));
  return Boolean(place);
}

let steps: Promise<void> = Promise.resolve();

/** Moves an end by a step in a pane [CSS px right, down], after the steps before, and says the length. */
export function stepEnd(id: number, end: "a" | "b", pane: MeasuringPane, [dx, dy]: readonly [number, number]): void {
  const step = async () => {
    const find = () => measurements.peek().find((one) => one.id === id);
    const from = find() && pane.place(find()![end]);
    if (!from) return;
    const moved = await moveEnd(id, end, pane, from.x + dx, from.y + dy);
    sayAtRest(() => (moved ? (find() ? lengthOf(find()!) : null) : "Nothing there"));
  };
  steps = steps.then(step);
}
