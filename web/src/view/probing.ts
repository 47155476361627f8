import { computed, effect, signal, type ReadonlySignal } from "@preact/signals";
import type { Vec3 } from "../geometry/vec3";
import { frame } from "../state/frame";
import type { Probe, ProbedPlace } from "../state/protocol";
import { probe } from "../state/session";
import { view } from "./overlay";

/** What is at places of the picture and of the slices. */

/** A place of the view area [CSS px], or a point of the volume [LPS mm]. */
export type Place = { x: number; y: number } | Vec3;

/** The place as the server is asked about it; null beside the picture. */
function probedPlace(place: Place): ProbedPlace | null {
  if (!("x" in place)) return { position_mm: place };
  const rect = view.peek()?.rect;
  if (!rect) return null;
  const x = (place.x - rect.x) / rect.width;
  const y = (place.y - rect.y) / rect.height;
  return x < 0 || x > 1 || y < 0 || y > 1 ? null : { x, y };
}

/** The anatomy at a place; null beside the picture, where nothing is, and without answer. */
export async function probeAt(place: Place): Promise<Probe | null> {
  const probed = probedPlace(place);
  const answer = probed && (await probe(probed));
  return answer?.hit ? answer : null;
}

const underPointer = signal<Probe | null>(null);
/** What is under the pointer, in the picture or in a slice; null where nothing is. */
export const pointed: ReadonlySignal<Probe | null> = underPointer;

const kPause_ms = 60;
const pointer = signal<(() => Place) | null>(null);
/** Where it is now; another object whenever something else may be there. Null: nowhere. */
let current: { place: Place } | null = null;
let asking = false;

/** The pointer is there; `place` may read signals, and is asked for anew when they change. Null: it is nowhere. */
export function pointAt(place: (() => Place) | null): void {
  pointer.value = place;
}

/** Changes with what the picture shows, not while that is only refined. */
const pictured = computed(() => {
  const header = frame.value?.header;
  return header ? `${header.revision} ${header.moving}` : "";
});

// What is there is read one at a time, and of the places meanwhile only the last.
effect(() => {
  const place = pointer.value?.();
  if (place && "x" in place) void pictured.value;
  current = place ? { place } : null;
  if (!place) underPointer.value = null;
  else if (!asking) void ask();
});

async function ask(): Promise<void> {
  asking = true;
  for (let asked: typeof current = null; current && current !== asked; ) {
    asked = current;
    const answer = await probeAt(asked.place);
    // It may have left meanwhile.
    if (current) underPointer.value = answer;
    await new Promise((resolve) => setTimeout(resolve, kPause_ms));
  }
  asking = false;
}
