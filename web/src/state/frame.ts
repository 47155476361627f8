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

const compilingShare = signal<number | null>(null);
/** How much of what the next picture needs before its samples is done, 0 to 1; null where that takes no time. */
export const compiling: ReadonlySignal<number | null> = compilingShare;

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

on("compiling", ({ share }) => {
  compilingShare.value = share < 1 ? share : null;
});

on("status", (message) => {
  compilingShare.value = null;
  if (message.stage !== "ready") newestProgress.value = null;
  if (message.stage === "empty") newest.value = null;
});

/** Tells the server that a picture is on screen, which lets it send the next ones. */
export function frameShown(number: number): void {
  send({ type: "shown", frame: number });
}
