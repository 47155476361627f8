import { batch, signal, type ReadonlySignal } from "@preact/signals";
import { on, send } from "./connection";

/** Thumbnails of the open volume with every preset, which the server draws when it is asked to. */

const turn = signal(0);
/** Grows by 1 with every volume that is opened, and with every connection: what was drawn before is gone. */
export const pictureTurn: ReadonlySignal<number> = turn;

const names = signal<ReadonlySet<string>>(new Set());
/** Presets whose pictures are there. */
export const drawnPresets: ReadonlySignal<ReadonlySet<string>> = names;

/** Asks for them all; each is in drawnPresets when it is drawn. */
export function drawPresets(): void {
  send({ type: "draw_presets" });
}

export function presetPicture(name: string): string {
  return `api/preset/${encodeURIComponent(name)}.png?turn=${turn.value}`;
}

on("status", ({ stage, given_up }) => {
  if (stage !== "ready" || given_up) return;
  batch(() => {
    ++turn.value;
    names.value = new Set();
  });
});
on("preset_drawn", ({ name }) => (names.value = new Set([...names.peek(), name])));
