import { computed, effect, signal, type ReadonlySignal } from "@preact/signals";
import { durationOf } from "../../model/keyframes";
import { canGoOn } from "../../state/edit-pace";
import { send } from "../../state/connection";
import { frame, type Frame } from "../../state/frame";
import { scene } from "../../state/scene";

/** The time that is shown of the animation, and its play back. */

const time = signal(0);
/** [s] */
export const playhead: ReadonlySignal<number> = time;

const seeking = signal(false);
/** Whether the picture shows the animation and not the scene as it is. */
export const previewing: ReadonlySignal<boolean> = seeking;

const running = signal(false);
export const playing: ReadonlySignal<boolean> = running;

export const duration: ReadonlySignal<number> = computed(() => durationOf(scene.value?.animation));

/** Puts the playhead there; the picture stays. */
export function placePlayhead(time_s: number): void {
  time.value = time_s;
}

/** Moves the playhead; with an animation the picture follows. */
export function seek(time_s: number): void {
  time.value = Math.max(0, time_s);
  if (duration.peek() === 0) return;
  seeking.value = true;
  send({ type: "seek", time_s: time.value });
}

/** Back to the scene as it is. */
export function endPreview(): void {
  running.value = false;
  if (!seeking.peek()) return;
  seeking.value = false;
  send({ type: "seek", time_s: null });
}

export function pause(): void {
  running.value = false;
}

/** No picture comes where two times look the same; then play goes on all the same. */
const kPatience_ms = 250;

function nextFrame(after: Frame | null): Promise<void> {
  return new Promise((resolve) => {
    let stop: (() => void) | undefined;
    const done = () => {
      clearTimeout(timer);
      queueMicrotask(() => stop?.());
      resolve();
    };
    const timer = setTimeout(done, kPatience_ms);
    stop = effect(() => {
      if (frame.value !== after) done();
    });
  });
}

/** Plays in real time, over and over; pictures that would come too late are left out. */
export async function play(): Promise<void> {
  if (running.peek()) return;
  running.value = true;
  let before = performance.now();
  if (time.peek() >= duration.peek() - 1e-3) time.value = 0;
  while (running.peek() && canGoOn() && duration.peek() > 0) {
    const shown = frame.peek();
    seek(time.peek());
    await Promise.all([nextFrame(shown), new Promise(requestAnimationFrame)]);
    const now = performance.now();
    const to = time.peek() + (now - before) / 1000;
    before = now;
    if (running.peek()) time.value = to % duration.peek();
  }
  running.value = false;
}

// Whoever changes what the animation moves wants to see that, and not the preview.
let seen = scene.peek();
effect(() => {
  const now = scene.value;
  const before = seen;
  seen = now;
  if (!now || !before || !seeking.peek()) return;
  if (
    now.camera !== before.camera ||
    now.transfer !== before.transfer ||
    now.lights !== before.lights ||
    now.clip !== before.clip
  )
    endPreview();
});
