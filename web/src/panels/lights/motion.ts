import { signal, type ReadonlySignal } from "@preact/signals";
import { dimmedLight, flashFactor, orbited, type Flash } from "../../model/light-motion";
import { link, on } from "../../state/connection";
import { canGoOn, shownAfter } from "../../state/edit-pace";
import { edit, flushEdits, newGesture, revision, scene } from "../../state/scene";

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

/** Ends it; a light that flashed has its own intensity again. */
export function stopMotion(): void {
  running.value = null;
  putBack();
}

/** Moves a light until stopMotion(), the tab is hidden or the light is another one or gone. All of it is one step of
 * undo. */
export async function startMotion(motion: Motion, light: number): Promise<void> {
  stopMotion();
  if (!canGoOn()) return;
  const self: Running = { motion, light };
  running.value = self;
  const gesture = newGesture(motion);
  if (motion === "flash") beginFlash(light, gesture);
  let before = performance.now();
  let share = 0;
  while (running.peek() === self && canGoOn()) {
    const now = scene.peek();
    const one = now?.lights?.[light];
    if (!now || !one || (flash && dimmedLight(flash, now.lights!) !== light)) break;
    const time = performance.now();
    const step = Math.min(0.1, (time - before) / 1000) / period.peek();
    before = time;
    share = (share + step) % 1;
    const since = revision.peek();
    if (flash) {
      flash.shown = flash.own * flashFactor(share);
      edit([[`/lights/${light}/intensity`, flash.shown]], gesture);
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

/** The flash at work, or one whose light has not got its own intensity back yet. */
let flash: Flash | null = null;
let flashGesture = "";

/** What is kept of it over a reload of the page. */
const kStored = "voxlume.flash";

const volumePath = () => scene.peek()?.volume.path ?? "";

function beginFlash(light: number, gesture: string): void {
  const lights = scene.peek()?.lights ?? [];
  const own = lights[light]?.intensity ?? 0;
  flash = { volume: volumePath(), light, count: lights.length, own, shown: own };
  flashGesture = gesture;
  const kept: Flash = { ...flash, shown: null };
  sessionStorage.setItem(kStored, JSON.stringify(kept));
}

/** Gives the light that flashed its own intensity. Without a connection that waits until there is one. */
function putBack(): void {
  const lights = scene.peek()?.lights;
  if (!flash || !lights || link.peek().kind !== "open") return;
  const index = flash.volume === volumePath() ? dimmedLight(flash, lights) : null;
  if (index !== null) edit([[`/lights/${index}/intensity`, flash.own]], flashGesture);
  flash = null;
  sessionStorage.removeItem(kStored);
}

/** Of a page that was reloaded, or a tab that the browser has restored. */
function storedFlash(): Flash | null {
  try {
    return JSON.parse(sessionStorage.getItem(kStored) ?? "null") as Flash | null;
  } catch {
    return null;
  }
}

flash = storedFlash();
on("hello", () => {
  if (flash) flash.shown = null;
});
on("scene", () => {
  if (!running.peek()) putBack();
});
addEventListener("pagehide", () => {
  stopMotion();
  flushEdits();
});
