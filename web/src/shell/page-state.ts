import { signal } from "@preact/signals";

export const helpShown = signal(false);
export const fullscreen = signal(false);

export function toggleFullscreen(): void {
  if (document.fullscreenElement) void document.exitFullscreen();
  else void document.documentElement.requestFullscreen().catch(() => undefined);
}

document.addEventListener("fullscreenchange", () => (fullscreen.value = document.fullscreenElement !== null));
