import { signal, type ReadonlySignal } from "@preact/signals";
import { flashFactor, orbited } from "../../model/light-motion";
import { canGoOn, shownAfter } from "../../state/edit-pace";
import { edit, newGesture, revision, scene } from "../../state/scene";

/** Lights that move by themselves, as in the program of xu2024: one light orbits the target, or one flashes. */

export type Motion = "orbit" | "flash";

interface Running {
  motion: Motion;
  light: number;
}

const running = signal<Running | null>(null);
/** What moves; null: nothing. */
export const moving: ReadonlySignal<Running | null> = running;
/** Of a turn or a flash [s]. */
export const period = signal(8);

/** An edit of somebody else, or of the camera, comes in between: wait until the hand rests. */
const kRest_ms = 400;
const wait = (ms: number) => new Promise((resolve) => setTimeout(resolve, ms));

export function stopMotion(): void {
  running.value = null;
}

/** Moves a light until stopMotion(), the tab is hidden or the light is gone. All of it is one step of undo. */
export async function startMotion(motion: Motion, light: number): Promise<void> {
  const self: Running = { motion, light };
  running.value = self;
  const gesture = newGesture(motion);
  const brightest = scene.peek()?.lights?.[light]?.intensity ?? 0;
  let before = performance.now();
  let share = 0;
  while (running.peek() === self && canGoOn()) {
    const now = scene.peek();
    const one = now?.lights?.[light];
    if (!now || !one) break;
    const time = performance.now();
    const step = Math.min(0.1, (time - before) / 1000) / period.peek();
    before = time;
    share = (share + step) % 1;
    const since = revision.peek();
    if (motion === "orbit") {
      const { field, value } = orbited(one, now.camera.target_mm ?? [0, 0, 0], 360 * step);
      edit([[`/lights/${light}/${field}`, value]], gesture);
    } else {
      edit([[`/lights/${light}/intensity`, brightest * flashFactor(share)]], gesture);
    }
    const camera = scene.peek()?.camera;
    await shownAfter(since);
    for (let seen = camera; running.peek() === self && scene.peek()?.camera !== seen;) {
      seen = scene.peek()?.camera;
      await wait(kRest_ms);
      before = performance.now();
    }
  }
  if (running.peek() === self) running.value = null;
}
