import { signal } from "@preact/signals";
import { layout } from "../state/preferences";

export const helpShown = signal(false);
export const fullscreen = signal(false);

export function toggleFullscreen(): void {
  if (document.fullscreenElement) void document.exitFullscreen();
  else void document.documentElement.requestFullscreen().catch(() => undefined);
}

document.addEventListener("fullscreenchange", () => (fullscreen.value = document.fullscreenElement !== null));

export function toggleSlices(): void {
  layout.value = layout.peek() === "slices" ? "picture" : "slices";
}
