import { computed, signal, type ReadonlySignal } from "@preact/signals";
import { mix } from "../geometry/vec3";
import {
  commonScale,
  pannedFraming,
  zoomedFraming,
  type PaneView,
  type Plane,
  type PlaneLayout,
  type Size,
  type Framing,
} from "../model/slice";
import { automaticWindow, ctWindows, type Window } from "../model/window";
import { keptOfVolumes } from "../state/kept";
import type { Vec3 } from "../state/scene-types";
import { volume } from "../state/volume";

/** What all slices share. */

const chosenWindow = keptOfVolumes<Window>("window");

/** The window that a volume starts with: soft tissue for CT, else what suits the values. */
export const initialWindow: ReadonlySignal<Window> = computed(() => {
  const facts = volume.value;
  if (!facts) return { level: 0, width: 1 };
  return facts.hounsfield ? ctWindows[0]!.window : automaticWindow(facts);
});

/** Values shown from black to white. */
export const sliceWindow: ReadonlySignal<Window> = computed(() => chosenWindow.now.value ?? initialWindow.value);

export function setWindow(window: Window): void {
  chosenWindow.set(window);
}

/** What dragging with the primary button does. */
export const dragTool = signal<"crosshair" | "window">("crosshair");

/** The label volume that is laid over the slices (a proxy's name or "labels"); "": none, null: the first there is. */
export const overlayVolume = signal<string | null>(null);
export const overlayOpacity = signal(0.45);

/** Sizes of the panes that are on the page [CSS px]. */
const paneSizes = signal<Partial<Record<Plane, Size>>>({});

/** Tells how large a pane is; null: it is gone. */
export function setPaneSize(plane: Plane, size: Size | null): void {
  const { [plane]: _, ...others } = paneSizes.peek();
  paneSizes.value = size ? { ...others, [plane]: size } : others;
}

const chosenFraming = keptOfVolumes<Framing>("framing");

/** Whether the panes show something else than all of every plane. */
export const slicesMoved: ReadonlySignal<boolean> = computed(() => chosenFraming.now.value !== null);

/** What all panes show: one middle, and one scale, so that lengths can be compared. */
const framing: ReadonlySignal<Framing> = computed(() => {
  const facts = volume.value;
  return chosenFraming.now.value ?? { center_mm: facts ? mix(...facts.bounds_mm, 0.5) : [0, 0, 0], zoom: 1 };
});

/** CSS px of 1 mm in all panes. */
const sliceScale: ReadonlySignal<number> = computed(() =>
  volume.value ? commonScale(volume.value.bounds_mm, paneSizes.value) * framing.value.zoom : 1,
);

export function paneView(size: Size): PaneView {
  return { ...size, center_mm: framing.value.center_mm, pxPerMm: sliceScale.value };
}

const setFraming = (to: Framing | null): void => chosenFraming.set(to);

/** Nearer by `factor` (> 1), or farther, in all panes; the point stays where it is seen. */
export function zoomSlices(factor: number, about: Vec3): void {
  setFraming(zoomedFraming(framing.peek(), factor, about));
}

/** Moves all panes along with a drag in one of them [CSS px]. */
export function panSlices(layout: PlaneLayout, dx: number, dy: number): void {
  const facts = volume.peek();
  if (facts) setFraming(pannedFraming(framing.peek(), layout, sliceScale.peek(), [dx, dy], facts.bounds_mm));
}

/** All of every plane again. */
export const resetSlices = (): void => setFraming(null);
