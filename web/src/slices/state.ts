import { computed, signal, type ReadonlySignal } from "@preact/signals";
import { ctWindows, percentileWindow, type Window } from "../model/window";
import { volume } from "../state/volume";

/** What all slices share. */

const chosenWindow = signal<{ of: string; window: Window } | null>(null);

/** The window that a volume starts with: soft tissue for CT, else nearly all values. */
export const initialWindow: ReadonlySignal<Window> = computed(() => {
  const facts = volume.value;
  if (!facts) return { level: 0, width: 1 };
  return facts.hounsfield ? ctWindows[0]!.window : percentileWindow(facts.percentiles, facts.range);
});

/** Values shown from black to white. */
export const sliceWindow: ReadonlySignal<Window> = computed(() =>
  chosenWindow.value?.of === volume.value?.name && chosenWindow.value ? chosenWindow.value.window : initialWindow.value,
);

export function setWindow(window: Window): void {
  chosenWindow.value = { of: volume.peek()?.name ?? "", window };
}

/** What dragging with the primary button does. */
export const dragTool = signal<"crosshair" | "window">("crosshair");

/** The label volume that is laid over the slices (a proxy's name or "labels"); "": none, null: the first there is. */
export const overlayVolume = signal<string | null>(null);
export const overlayOpacity = signal(0.45);
