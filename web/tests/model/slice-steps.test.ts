import { describe, expect, it } from "vitest";
import { nearestPlane, planeAt_mm, planesOn_mm, sliceSteps } from "../../src/model/slice-steps";
import type { Vec3 } from "../../src/state/scene-types";

const straight = [1, 0, 0, 0, 1, 0, 0, 0, 1];

/** Turned about x by an angle: columns are the grid's axes. */
function tilted(deg: number): number[] {
  const [c, s] = [Math.cos((deg * Math.PI) / 180), Math.sin((deg * Math.PI) / 180)];
  return [1, 0, 0, 0, c, -s, 0, s, c];
}

/** Of a grid about `middle`. */
function factsOf(size: Vec3, spacing_mm: Vec3, direction = straight, middle: Vec3 = [0, 0, 0]) {
  const half = ([0, 1, 2] as const).map((a) =>
    [0, 1, 2].reduce((sum, g) => sum + (Math.abs(direction[3 * a + g]!) * size[g]! * spacing_mm[g]!) / 2, 0),
  );
  const bounds = [-1, 1].map((sign) => middle.map((x, a) => x + sign * half[a]!) as unknown as Vec3);
  return { size, spacing_mm, direction, bounds_mm: [bounds[0]!, bounds[1]!] as const };
}

describe("slices of a pane", () => {
  it("are the acquired ones, on the centres of their voxels", () => {
    const ct = factsOf([256, 256, 108], [0.96, 0.96, 1.5], straight, [0, 0, 100]);
    const steps = sliceSteps(ct, 2);
    expect(steps.count).toBe(108);
    expect(steps.step_mm).toBeCloseTo(1.5);
    expect(steps.first_mm).toBeCloseTo(100 - 81 + 0.75);
    expect(planeAt_mm(steps, 107)).toBeCloseTo(100 + 81 - 0.75);
    expect(sliceSteps(ct, 0)).toMatchObject({ count: 256, step_mm: 0.96 });
  });

  it("are those of the grid's axis that lies along the pane's", () => {
    // Sagittal slices of a cube: their number is along x.
    const sagittal = factsOf([80, 80, 10], [1, 1, 8], [0, 0, 1, 1, 0, 0, 0, -1, 0]);
    expect(sliceSteps(sagittal, 0)).toMatchObject({ count: 10, step_mm: 8, first_mm: -36 });
    expect(sliceSteps(sagittal, 1)).toMatchObject({ count: 80, step_mm: 1 });
    expect(sliceSteps(sagittal, 2)).toMatchObject({ count: 80, step_mm: 1 });
  });

  it("of a tilted volume are met one after the other on the line through its middle", () => {
    const steps = sliceSteps(factsOf([200, 200, 21], [0.5, 0.5, 5], tilted(15)), 2);
    expect(steps.step_mm).toBeCloseTo(5 / Math.cos(Math.PI / 12));
    // The middle slice is the volume's middle; further ones meet only its corners.
    expect(planeAt_mm(steps, (steps.count - 1) / 2)).toBeCloseTo(0);
    expect(steps.count).toBe(21 + 2);
  });

  it("of an oblique volume are as far apart as its voxels are there", () => {
    const oblique = factsOf([100, 100, 20], [1, 1, 5], tilted(45));
    const steps = sliceSteps(oblique, 2);
    expect(steps.step_mm).toBeCloseTo(Math.SQRT2);
    expect(steps.first_mm).toBeGreaterThanOrEqual(oblique.bounds_mm[0][2]);
    expect(planeAt_mm(steps, steps.count - 1)).toBeLessThanOrEqual(oblique.bounds_mm[1][2]);
    expect(steps.count).toBe(100);
  });

  it("are gone through one by one, and no further than the last", () => {
    const steps = { first_mm: -36, step_mm: 8, count: 10 };
    expect(planesOn_mm(steps, -4, 1)).toBe(4);
    expect(planesOn_mm(steps, -4, -2)).toBe(-20);
    expect(planesOn_mm(steps, 0, 1)).toBe(4);
    expect(planesOn_mm(steps, 0, -1)).toBe(-4);
    expect(planesOn_mm(steps, -4.0000001, 1)).toBe(4);
    expect(planesOn_mm(steps, 30, 10)).toBe(36);
    expect(planesOn_mm(steps, 40, 1)).toBe(36);
    expect(nearestPlane(steps, 5)).toBe(5);
    expect(nearestPlane(steps, 40)).toBe(9);
    expect(nearestPlane({ first_mm: 3, step_mm: 1, count: 1 }, 3)).toBe(0);
  });
});
