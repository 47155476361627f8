import { effect, signal, type Signal } from "@preact/signals";

/** What this browser remembers; no part of the scene. */

/** A signal that the browser keeps as `voxlume.KEY`: for ever, or as long as `storage` does. */
export function remembered<T>(key: string, otherwise: T, storage = () => localStorage): Signal<T> {
  let start = otherwise;
  try {
    const text = storage().getItem(`voxlume.${key}`);
    if (text !== null) start = JSON.parse(text) as T;
  } catch {
    // No storage, or not ours: the default holds.
  }
  const value = signal(start);
  effect(() => {
    try {
      storage().setItem(`voxlume.${key}`, JSON.stringify(value.value));
    } catch {
      // Without storage it holds until the page is closed.
    }
  });
  return value;
}

export type Theme = "system" | "dark" | "light";
/** "system" is light where the system asks for it, else dark. */
export const theme = remembered<Theme>("theme", "system");

/** Pixels of the picture per CSS pixel of the view. */
export const resolution = remembered<number>("resolution", 1);

/** Id of the panel that is open beside the picture; null: none. */
export const sidePanel = remembered<string | null>("side-panel", null);
/** Id of the panel that is open below the picture; null: none. */
export const bottomPanel = remembered<string | null>("bottom-panel", null);

export type Layout = "picture" | "slices";
/** The picture alone, or with the three slices through the crosshair beside it. */
export const layout = remembered<Layout>("layout", "picture");
