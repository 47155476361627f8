import { signal, type ReadonlySignal } from "@preact/signals";
import type { Probe } from "../state/protocol";
import { probe } from "../state/session";
import { view } from "./overlay";

/** What is at places of the view area. */

/** The anatomy at a place of the view area [CSS px]; null beside the picture, where nothing is, and without answer. */
export async function probeAt(x: number, y: number): Promise<Probe | null> {
  const rect = view.peek()?.rect;
  if (!rect) return null;
  const across = (x - rect.x) / rect.width;
  const down = (y - rect.y) / rect.height;
  if (across < 0 || across > 1 || down < 0 || down > 1) return null;
  const answer = await probe(across, down);
  return answer?.hit ? answer : null;
}

const underPointer = signal<Probe | null>(null);
/** What is under the pointer; null where nothing is. */
export const pointed: ReadonlySignal<Probe | null> = underPointer;

const kPause_ms = 60;
let wanted: { x: number; y: number } | null = null;
let asking = false;

/** The pointer is here [CSS px of the view area]: asked one at a time, and of the places meanwhile only the last. */
export function pointAt(place: { x: number; y: number } | null): void {
  wanted = place;
  if (!place) underPointer.value = null;
  if (!asking && place) void ask();
}

async function ask(): Promise<void> {
  asking = true;
  while (wanted) {
    const { x, y } = wanted;
    wanted = null;
    const answer = await probeAt(x, y);
    underPointer.value = answer;
    await new Promise((resolve) => setTimeout(resolve, kPause_ms));
  }
  asking = false;
}
