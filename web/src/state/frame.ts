import { signal, type ReadonlySignal } from "@preact/signals";
import { on, onFrame, send } from "./connection";
import type { FrameHeader, Progress } from "./protocol";

/** The newest picture. */

export interface Frame {
  header: FrameHeader;
  picture: ImageBitmap;
}

const newest = signal<Frame | null>(null);
/** The newest picture that arrived; null before the first and while nothing is open. Older bitmaps are closed. */
export const frame: ReadonlySignal<Frame | null> = newest;

const newestProgress = signal<Progress | null>(null);
/** How far the still picture is; null while the view moves. */
export const progress: ReadonlySignal<Progress | null> = newestProgress;

let decoding: Promise<void> = Promise.resolve();

onFrame((header, data) => {
  // One after the other, so that an older picture never replaces a newer one.
  decoding = decoding.then(async () => {
    const picture = await createImageBitmap(data).catch(() => null);
    if (!picture) return frameShown(header.frame);
    const before = newest.peek();
    newest.value = { header, picture };
    before?.picture.close();
    if (header.moving) newestProgress.value = null;
  });
});

on("progress", (message) => {
  newestProgress.value = message;
});

on("status", (message) => {
  if (message.stage !== "ready") newestProgress.value = null;
  if (message.stage === "empty") newest.value = null;
});

/** Tells the server that a picture is on screen, which lets it send the next ones. */
export function frameShown(number: number): void {
  send({ type: "shown", frame: number });
}
