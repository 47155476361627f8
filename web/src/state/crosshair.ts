import { computed, type ReadonlySignal } from "@preact/signals";
import { keptOfVolumes } from "./kept";
import type { Vec3 } from "./scene-types";
import { volume } from "./volume";

/** The point that slices and the picture mark together. */

const chosen = keptOfVolumes<Vec3>("crosshair");

/** LPS mm; the volume's middle until another point is chosen. Null while no volume is open. */
export const crosshair: ReadonlySignal<Vec3 | null> = computed(() => {
  const facts = volume.value;
  if (!facts) return null;
  if (chosen.now.value) return chosen.now.value;
  const [lo, hi] = facts.bounds_mm;
  return [(lo[0] + hi[0]) / 2, (lo[1] + hi[1]) / 2, (lo[2] + hi[2]) / 2];
});

/** Moves the crosshair, kept within the volume. */
export function setCrosshair(p: Vec3): void {
  const facts = volume.peek();
  if (!facts) return;
  const [lo, hi] = facts.bounds_mm;
  chosen.set(p.map((x, i) => Math.min(hi[i]!, Math.max(lo[i]!, x))) as unknown as Vec3);
}
