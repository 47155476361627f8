import { computed, effect, signal, type ReadonlySignal } from "@preact/signals";
import { formatDistance, formatPosition } from "../geometry/length";
import { distance, type Vec3 } from "../geometry/vec3";
import { keptOfVolumes } from "../state/kept";
import { lengthScale } from "../state/lengths";
import { pointerTool } from "../state/tools";
import { volumeKey } from "../state/volume";
import { showToast } from "../ui/toast";
import { probeAt, type Place } from "./probing";

/** Distances between points of the anatomy. They belong to this page and a volume, not to the scene. */

export interface Measurement {
  /** When it was measured [ms]; no two have the same. */
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
  /** The same for as long as a pointer rests there: reads signals of what the pane shows. */
  under(x: number, y: number): () => Place;
}

const kept = keptOfVolumes<readonly Measurement[]>("distances");
/** Of the open volume. */
export const measurements: ReadonlySignal<readonly Measurement[]> = computed(() => kept.now.value ?? []);
const first = signal<Vec3 | null>(null);
/** The first end of a distance whose second is not set yet. */
export const begun: ReadonlySignal<Vec3 | null> = first;
export const measuring = computed(() => pointerTool.value === "measure");

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

effect(() => {
  void volumeKey.value;
  first.value = null;
});

/** Removes distances and tells so, with a button that brings them back. */
function remove(gone: readonly Measurement[], what: string): void {
  const of = volumeKey.peek();
  kept.set(measurements.peek().filter((one) => !gone.includes(one)));
  say("");
  const putBack = () => kept.set([...(kept.of(of) ?? []), ...gone].sort((a, b) => a.id - b.id), of);
  showToast({ text: `${what} deleted`, action: { label: "Undo", run: putBack } });
}

export function removeAll(): void {
  const all = measurements.peek();
  first.value = null;
  remove(all, all.length === 1 ? "A distance" : `${all.length} distances`);
}

export function removeMeasurement(id: number): void {
  const gone = measurements.peek().filter((one) => one.id === id);
  if (gone[0]) remove(gone, `Distance of ${lengthOf(gone[0])}`);
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
  const added = { id: Date.now(), a: first.value, b: place };
  kept.set([...measurements.peek(), added]);
  first.value = null;
  say(`Distance ${lengthOf(added)}`);
}

/** Moves an end to a place of a pane [CSS px]; false where there is nothing. */
export async function moveEnd(id: number, end: "a" | "b", pane: MeasuringPane, x: number, y: number): Promise<boolean> {
  const place = await probed(pane, x, y);
  if (place) kept.set(measurements.peek().map((one) => (one.id === id ? { ...one, [end]: place } : one)));
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
