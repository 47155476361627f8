import { describe, expect, it } from "vitest";
import { axesOf, byAngles, heightAtTarget_mm, orbited, panned, turned, zoomed } from "../src/geometry/orbit";
import { formatCoordinate, formatDistance, formatPosition, lengthScale, parseCoordinate, scaleInMm } from "../src/geometry/length";
import { orientationLabel, type Axis } from "../src/geometry/orientation";
import { heightAtDepth_mm, nearestOnLine, pointAtDepth, project, ray } from "../src/geometry/projection";
import { add, cross, dot, length, scale, sub, type Vec3 } from "../src/geometry/vec3";
import type { FrameCamera } from "../src/state/protocol";
import type { Camera } from "../src/state/scene-types";

const start: Camera = {
  projection: "perspective",
  azimuth_deg: 0,
  elevation_deg: 0,
  roll_deg: 0,
  zoom: 1,
  vertical_fov_deg: 30,
  target_mm: [10, -20, 30],
  aperture_radius_mm: 0,
  background_blur_deg: 0,
  fit_radius_mm: 150,
};
const around = { center_mm: [0, 0, 0] as Vec3, radius_mm: 120, aspect: 1.5 };

function expectNear(a: Vec3, b: Vec3, digits = 6) {
  a.forEach((value, i) => expect(value).toBeCloseTo(b[i]!, digits));
}

/** As the server makes it of a scene's camera (perspective, by angles). */
function frameCamera(camera: Camera): FrameCamera {
  const axes = axesOf(camera, around);
  const half_height = Math.tan((camera.vertical_fov_deg * Math.PI) / 360);
  const distance = heightAtTarget_mm(camera, around) / (2 * half_height);
  const eye_mm = sub(camera.target_mm!, scale(axes.forward, distance));
  return { eye_mm, ...axes, half_width: half_height * around.aspect, half_height, orthographic: false };
}

describe("projection", () => {
  const perspective = frameCamera({ ...start, azimuth_deg: 40, elevation_deg: 25, roll_deg: 15 });
  const orthographic = { ...perspective, orthographic: true, half_width: 150, half_height: 100 };
  for (const camera of [perspective, orthographic]) {
    it(`a point on the ray of a place is seen there (orthographic: ${camera.orthographic})`, () => {
      const from = ray(camera, 0.2, 0.85);
      const seen = project(camera, add(from.origin, scale(from.direction, 321)));
      expect(seen.x).toBeCloseTo(0.2, 9);
      expect(seen.y).toBeCloseTo(0.85, 9);
      expect(length(from.direction)).toBeCloseTo(1, 12);
    });
    it(`a point at a depth has that depth (orthographic: ${camera.orthographic})`, () => {
      expect(project(camera, pointAtDepth(camera, 0.9, 0.1, 77)).depth_mm).toBeCloseTo(77, 9);
      const low = pointAtDepth(camera, 0.5, 1, 77);
      const high = pointAtDepth(camera, 0.5, 0, 77);
      expect(length(sub(high, low))).toBeCloseTo(heightAtDepth_mm(camera, 77), 9);
    });
  }
  it("the target is in the middle", () => {
    const seen = project(perspective, start.target_mm!);
    expect([seen.x, seen.y]).toEqual([expect.closeTo(0.5, 9), expect.closeTo(0.5, 9)]);
  });
  it("finds where a line is nearest to a ray", () => {
    const seen = { origin: [0, -100, 5] as Vec3, direction: [0, 1, 0] as Vec3 };
    expect(nearestOnLine([0, 0, 0], [0, 0, 1], seen)).toBeCloseTo(5, 9);
    expect(nearestOnLine([0, 0, 0], [0, 1, 0], seen)).toBeNull();
  });
});

describe("the camera's conventions", () => {
  it("0, 0 looks at the face, head up, the patient's left at the right", () => {
    const axes = axesOf(start, around);
    expectNear(axes.forward, [0, 1, 0]);
    expectNear(axes.up, [0, 0, 1]);
    expectNear(axes.right, [1, 0, 0]);
  });
  it("azimuth 90 looks from the left, elevation 90 from the head", () => {
    expectNear(axesOf({ ...start, azimuth_deg: 90 }, around).forward, [-1, 0, 0]);
    expectNear(axesOf({ ...start, elevation_deg: 90 }, around).forward, [0, 0, -1]);
  });
  it("axes are orthonormal and right-handed everywhere", () => {
    for (const [azimuth_deg, elevation_deg, roll_deg] of [
      [30, 20, 10],
      [-170, -90, 75],
      [0, 90, -30],
    ] as const) {
      const { right, up, forward } = axesOf({ ...start, azimuth_deg, elevation_deg, roll_deg }, around);
      expect(dot(right, up)).toBeCloseTo(0, 12);
      expectNear(cross(right, forward), up);
    }
  });
});

describe("moving the camera", () => {
  it("what is nearest follows a drag, rolled or not", () => {
    for (const roll_deg of [0, 35, -120]) {
      const camera = { ...start, azimuth_deg: 20, elevation_deg: 10, roll_deg };
      const before = frameCamera(camera);
      const near = sub(camera.target_mm!, scale(before.forward, 50));
      const seen = project(before, near);
      const right = project(frameCamera(orbited(camera, around, 2, 0)), near);
      expect(right.x - seen.x).toBeGreaterThan(0.001);
      expect(Math.abs(right.y - seen.y)).toBeLessThan(0.2 * (right.x - seen.x));
      const up = project(frameCamera(orbited(camera, around, 0, 2)), near);
      expect(seen.y - up.y).toBeGreaterThan(0.001);
    }
  });
  it("elevation ends at the poles, azimuth goes round", () => {
    expect(orbited(start, around, 0, -500).elevation_deg).toBe(90);
    expect(orbited({ ...start, azimuth_deg: -170 }, around, 20, 0).azimuth_deg).toBeCloseTo(170, 9);
  });
  it("panning moves the target's plane by the drag", () => {
    const camera = { ...start, azimuth_deg: 50, roll_deg: 20 };
    const height = heightAtTarget_mm(camera, around);
    const seen = project(frameCamera(panned(camera, around, 0.1 * height, 0.2 * height)), camera.target_mm!);
    expect(seen.x).toBeCloseTo(0.5 + 0.1 / around.aspect, 9);
    expect(seen.y).toBeCloseTo(0.5 - 0.2, 9);
  });
  it("zoom 2 halves what the picture covers, roll turns the picture clockwise", () => {
    expect(heightAtTarget_mm(zoomed(start, around, 2), around)).toBeCloseTo(heightAtTarget_mm(start, around) / 2, 9);
    const above = add(start.target_mm!, [0, 0, 20]);
    expect(project(frameCamera(turned(start, around, 30)), above).x).toBeGreaterThan(0.5);
  });
  it("a camera given by its eye is the same by angles", () => {
    const camera: Camera = { ...start, eye_mm: [300, -250, 180], up: [0.2, 0.1, 1], roll_deg: 12 };
    const same = byAngles(camera, around);
    expect(same.eye_mm).toBeUndefined();
    const a = axesOf(camera, around);
    const b = axesOf(same, around);
    expectNear(b.right, a.right);
    expectNear(b.up, a.up);
    expectNear(frameCamera(same).eye_mm, camera.eye_mm!, 4);
  });
  it("also from straight above", () => {
    const camera: Camera = { ...start, eye_mm: [10, -20, 400] };
    expectNear(axesOf(byAngles(camera, around), around).up, axesOf(camera, around).up);
  });
});

describe("orientation labels", () => {
  it("are the letters of the strongest directions first", () => {
    expect(orientationLabel([1, 0, 0])).toBe("L");
    expect(orientationLabel([-0.9, -0.43, 0])).toBe("RA");
    expect(orientationLabel([0.1, 0.2, -0.97])).toBe("I");
    expect(orientationLabel([0.5, 0.6, 0.62])).toBe("SPL");
  });
});

describe("positions", () => {
  const clinical = lengthScale(0.7);
  it("are told by the patient's sides, without a sign", () => {
    expect(formatPosition([-12.34, 7, 40.25], clinical)).toBe("R 12.3  P 7.0  S 40.3 mm");
    expect(formatPosition([12.34, -7, -40], clinical)).toBe("L 12.3  A 7.0  I 40.0 mm");
  });
  it("have one letter for 0, whatever it is rounded from", () => {
    for (const zero of [0, -0, 0.04, -0.04]) expect(formatPosition([zero, zero, zero], clinical)).toBe("L 0.0  P 0.0  S 0.0 mm");
    expect(formatCoordinate(0, -0.06, clinical)).toBe("R 0.1");
  });
  it("are read as they are written, and as numbers of LPS", () => {
    for (const axis of [0, 1, 2] as Axis[])
      for (const mm of [-12.5, 0, 3.1]) expect(parseCoordinate(axis, formatCoordinate(axis, mm, clinical))).toBeCloseTo(mm, 9);
    expect(parseCoordinate(0, "r10,5")).toBe(-10.5);
    expect(parseCoordinate(1, " -7 ")).toBe(-7);
  });
  it("are not read of another axis or of no number", () => {
    for (const text of ["S 10", "", "L", "L x", "10 mm", "1.2.3"]) expect(parseCoordinate(0, text)).toBeNaN();
  });
});

describe("lengths", () => {
  const voxels_mm = [2e-6, 5e-6, 1e-4, 0.003, 0.02, 0.3, 0.96, 8, 250, 1e5];
  it("have a unit in which a voxel is not small, and digits that tell its places apart", () => {
    expect(voxels_mm.map((voxel) => lengthScale(voxel).unit)).toEqual(["nm", "nm", "µm", "µm", "mm", "mm", "mm", "mm", "m", "m"]);
    for (const voxel of voxels_mm)
      for (const scale of [lengthScale(voxel), scaleInMm(voxel)]) {
        const places = [1, 1.5, 2, 2.5].map((n) => formatCoordinate(2, n * voxel, scale));
        expect(new Set(places).size, `${places}`).toBe(4);
      }
    expect(voxels_mm.map((voxel) => lengthScale(voxel).digits)).toEqual([1, 1, 2, 1, 3, 2, 1, 1, 2, 0]);
  });
  it("are measured in that unit", () => {
    expect(formatDistance(0.003, lengthScale(1e-4))).toBe("3.00 µm");
    expect(formatDistance(12.34, lengthScale(0.96))).toBe("12.3 mm");
    expect(formatDistance(123.4, lengthScale(0.96))).toBe("123 mm");
    expect(formatDistance(3.2e6, lengthScale(1e5))).toBe("3200 m");
    expect(formatPosition([-0.003, 0, 0.00125], lengthScale(1e-4))).toBe("R 3.00  P 0.00  S 1.25 µm");
  });
});
