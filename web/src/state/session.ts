import { signal, type ReadonlySignal } from "@preact/signals";
import { on, send } from "./connection";
import type { ExportState, Hello, Probe, ProbedPlace, Status } from "./protocol";

/** What the server says about the session besides scene and pictures. */

const helloSignal = signal<Hello | null>(null);
/** Lists of presets, materials, denoisers, environments and samples; null before the first connection. */
export const hello: ReadonlySignal<Hello | null> = helloSignal;

const statusSignal = signal<Status>({ type: "status", stage: "empty" });
export const status: ReadonlySignal<Status> = statusSignal;

const exportSignal = signal<ExportState | null>(null);
/** The animation that is being written, or was last. */
export const exporting: ReadonlySignal<ExportState | null> = exportSignal;

const splitSignal = signal<number | null>(null);
/** Left of this share of the width the picture is without denoiser; null: no split. */
export const split: ReadonlySignal<number | null> = splitSignal;

const warningsSignal = signal<readonly string[]>([]);
/** What of the scene may not be as its user expects: labels that lie nowhere in the volume, nothing to be seen. */
export const warnings: ReadonlySignal<readonly string[]> = warningsSignal;

const viewersSignal = signal(1);
export const viewers: ReadonlySignal<number> = viewersSignal;

/** Ends the opening of what is being read or prepared; what was open before stays. */
export function cancelOpening(): void {
  send({ type: "cancel_open" });
}

let splitQueued = false;

/** Moves the split, or ends it (null). The newest position is sent once an animation frame. */
export function setSplit(at: number | null): void {
  splitSignal.value = at;
  if (splitQueued) return;
  splitQueued = true;
  requestAnimationFrame(() => {
    splitQueued = false;
    send({ type: "split", at: splitSignal.value });
  });
}

let probes = 0;
const waiting = new Map<number, (answer: Probe) => void>();

/** What is at a place. Null when the connection is lost before the answer. */
export function probe(place: ProbedPlace): Promise<Probe | null> {
  const id = ++probes;
  return new Promise((resolve) => {
    if (!send({ type: "probe", id, ...place })) return resolve(null);
    waiting.set(id, resolve);
    setTimeout(() => {
      if (waiting.delete(id)) resolve(null);
    }, 5000);
  });
}

on("probe", (answer) => {
  waiting.get(answer.id)?.(answer);
  waiting.delete(answer.id);
});
on("hello", (message) => (helloSignal.value = message));
on("status", (message) => (statusSignal.value = message));
on("warnings", (message) => (warningsSignal.value = message.lines));
on("export", (message) => (exportSignal.value = message));
on("split", (message) => (splitSignal.value = message.at));
on("viewers", (message) => (viewersSignal.value = message.count));
