import { computed, type ReadonlySignal } from "@preact/signals";
import { remembered } from "./preferences";
import { volumeKey } from "./volume";

/** What a page keeps of every volume that it has shown, also when it is reloaded, until its tab is closed. No part of
 * the scene. */

export interface Kept<T> {
  /** Of the open volume; null where there is nothing. */
  readonly now: ReadonlySignal<T | null>;
  /** Of a volume by its key; null where there is nothing. */
  of(key: string | null): T | null;
  /** Keeps something of a volume, the open one unless told; null: nothing any more. */
  set(value: T | null, key?: string | null): void;
}

export function keptOfVolumes<T>(name: string): Kept<T> {
  const all = remembered<Record<string, T>>(name, {}, () => sessionStorage);
  return {
    now: computed(() => all.value[volumeKey.value ?? ""] ?? null),
    of: (key) => all.peek()[key ?? ""] ?? null,
    set(value, key = volumeKey.peek()) {
      if (key === null) return;
      const { [key]: _, ...others } = all.peek();
      all.value = value === null ? others : { ...others, [key]: value };
    },
  };
}
