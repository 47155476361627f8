import { signal, type ReadonlySignal } from "@preact/signals";
import { flashFactor, orbited } from "../../model/light-motion";
import { canGoOn, shownAfter } from "../../state/edit-pace";
import { edit, newGesture, revision, scene, showPassing } from "../../state/scene";

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

/** Ends it; a light that flashed is seen as it is again. */
export function stopMotion(): void {
  if (running.peek()?.motion === "flash") showPassing([]);
  running.value = null;
}

/** Moves a light until stopMotion(), the tab is hidden, or there are more or fewer lights. A turn is one step of undo;
 * a flash is only seen, and leaves the scene alone. */
export async function startMotion(motion: Motion, light: number): Promise<void> {
  stopMotion();
  if (!canGoOn()) return;
  const self: Running = { motion, light };
  running.value = self;
  const gesture = newGesture(motion);
  const ofScene = () => `${scene.peek()?.lights?.length} ${scene.peek()?.volume.path}`;
  const began = ofScene();
  let before = performance.now();
  let share = 0;
  while (running.peek() === self && canGoOn()) {
    const now = scene.peek();
    const one = now?.lights?.[light];
    if (!now || !one || ofScene() !== began) break;
    const time = performance.now();
    const step = Math.min(0.1, (time - before) / 1000) / period.peek();
    before = time;
    share = (share + step) % 1;
    const since = revision.peek();
    if (motion === "flash") {
      showPassing([[`/lights/${light}/intensity`, one.intensity * flashFactor(share)]]);
    } else {
      const { field, value } = orbited(one, now.camera.target_mm ?? [0, 0, 0], 360 * step);
      edit([[`/lights/${light}/${field}`, value]], gesture);
    }
    const camera = scene.peek()?.camera;
    await shownAfter(since);
    for (let seen = camera; running.peek() === self && scene.peek()?.camera !== seen;) {
      seen = scene.peek()?.camera;
      await wait(kRest_ms);
      before = performance.now();
    }
  }
  if (running.peek() === self) stopMotion();
}
