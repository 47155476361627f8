import { computed } from "@preact/signals";
import * as lengths from "../geometry/length";
import { volume } from "./volume";

/** How lengths and places are written of the volume that is open. */

/** The smallest side of a voxel. */
const voxel_mm = computed(() => (volume.value ? Math.min(...volume.value.spacing_mm) : 1));

/** Of what is told. */
export const lengthScale = computed(() => lengths.lengthScale(voxel_mm.value));
/** Of what is typed: mm, as the scene has it. */
export const typedScale = computed(() => lengths.scaleInMm(voxel_mm.value));
/** What the arrow keys change lengths by, for 1 mm of an ordinary volume: about a voxel. */
export const typedStep_mm = computed(() => 10 ** Math.round(Math.log10(voxel_mm.value)));

/** Sliders of lengths reach as far as bodies and their parts are large. Of volumes that are far smaller or larger,
 * they reach by this factor, a power of ten. */
export const reachFactor = computed(() => {
  if (!volume.value) return 1;
  const [lo, hi] = volume.value.bounds_mm;
  const side_mm = Math.max(...hi.map((x, i) => x - lo[i]!));
  return side_mm >= 10 && side_mm < 1e4 ? 1 : 10 ** (Math.floor(Math.log10(side_mm)) - 2);
});
