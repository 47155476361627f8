import type { Axis } from "../geometry/orientation";
import { mix } from "../geometry/vec3";
import type { VolumeFacts } from "../state/volume";

/** The planes that a pane goes through one by one: those of the acquired slices, where its axis is one of the grid's. */
export interface SliceSteps {
  /** Where the first plane is along the pane's axis [LPS mm]. */
  first_mm: number;
  step_mm: number;
  count: number;
}

/** An axis of the grid is meant up to this angle; it makes room for tilted gantries. */
const kLeastCosine = Math.cos(Math.PI / 6);

/** From one layer of voxels to the next along the LPS axis, by each axis of the grid [mm]. */
function layers_mm(facts: Pick<VolumeFacts, "spacing_mm" | "direction">, axis: Axis) {
  return ([0, 1, 2] as const).map((i) => {
    const cosine = Math.abs(facts.direction[3 * axis + i]!);
    return { i, cosine, mm: cosine > 0 ? facts.spacing_mm[i] / cosine : Infinity };
  });
}

/** The planes across an LPS axis. They lie on the centres of the voxels there are on the line through the volume's
 * middle; of a grid that is oblique to the axis, as far apart as layers of voxels are on that line. */
export function sliceSteps(
  facts: Pick<VolumeFacts, "size" | "spacing_mm" | "direction" | "bounds_mm">,
  axis: Axis,
): SliceSteps {
  const layers = layers_mm(facts, axis);
  const along = layers.find(({ cosine }) => cosine >= kLeastCosine);
  const step_mm = along?.mm ?? Math.min(...layers.map(({ mm }) => mm));
  const [lo, hi] = facts.bounds_mm;
  // Beyond the line, corners of a tilted volume: as many planes more on either side as fit.
  const fit = (hi[axis] - lo[axis]) / step_mm;
  const size = along ? facts.size[along.i] : Math.max(1, Math.round(fit));
  const count = size + 2 * Math.max(0, Math.floor((fit - size) / 2 + 1e-6));
  const middle = mix(lo, hi, 0.5)[axis];
  return { first_mm: middle - ((count - 1) / 2) * step_mm, step_mm, count };
}

export const planeAt_mm = ({ first_mm, step_mm }: SliceSteps, number: number): number => first_mm + number * step_mm;

const kept = ({ count }: SliceSteps, number: number) => Math.min(count - 1, Math.max(0, number));

/** Number of the plane that is nearest to a place. */
export const nearestPlane = (steps: SliceSteps, mm: number): number =>
  kept(steps, Math.round((mm - steps.first_mm) / steps.step_mm));

/** The place `by` planes on; from between two the next one is the first. */
export function planesOn_mm(steps: SliceSteps, mm: number, by: number): number {
  const from = (mm - steps.first_mm) / steps.step_mm;
  const nearest = Math.round(from);
  const start = Math.abs(from - nearest) < 1e-3 ? nearest : by > 0 ? Math.floor(from) : Math.ceil(from);
  return planeAt_mm(steps, kept(steps, start + by));
}
