import { describe, expect, it } from "vitest";
import {
  directionField,
  onSphere,
  positionField,
  rectCorners,
  worldDirection,
  worldPosition,
} from "../src/geometry/light-place";
import { formatRoundLength, niceLength } from "../src/geometry/length";
import { cross, distance, dot, length, mix, normalize, sub, type Vec3 } from "../src/geometry/vec3";
import type { Light } from "../src/state/scene-types";
import { letterbox } from "../src/view/overlay";

const forward = normalize([0.3, 0.8, -0.2]);
const right = normalize(cross(forward, [0, 0, 1]));
const camera = { target_mm: [5, 6, 7] as Vec3, right, up: cross(right, forward), forward };
const light: Light = {
  kind: "rect",
  attached_to: "camera",
  color: "#ffffff",
  intensity: 1,
  position_mm: [100, 200, 300],
  direction: [0.1, 0.2, 0.3],
  size_mm: [40, 20],
  two_sided: false,
};

describe("lights", () => {
  for (const attached_to of ["world", "camera"] as const) {
    it(`come back from world space as they were (${attached_to})`, () => {
      const one = { ...light, attached_to };
      const position = positionField(one, worldPosition(one, camera), camera);
      position.forEach((value, i) => expect(value).toBeCloseTo(light.position_mm![i]!, 9));
      const direction = directionField(one, worldDirection(one, camera), camera);
      expect(dot(normalize(direction), normalize(light.direction!))).toBeCloseTo(1, 12);
    });
  }
  it("of the camera are given by right, up and toward the eye", () => {
    expect(dot(worldDirection({ ...light, direction: [0, 0, 2] }, camera), forward)).toBeCloseTo(-1, 12);
    expect(dot(worldDirection({ ...light, direction: [1, 0, 0] }, camera), right)).toBeCloseTo(1, 12);
  });
  it("with an area face their target, width by height", () => {
    const corners = rectCorners(light, camera);
    expect(distance(corners[0]!, corners[1]!)).toBeCloseTo(40, 9);
    expect(distance(corners[1]!, corners[2]!)).toBeCloseTo(20, 9);
    const center = mix(corners[0]!, corners[2]!, 0.5);
    expect(distance(center, worldPosition(light, camera))).toBeCloseTo(0, 9);
    expect(dot(sub(camera.target_mm, center), sub(corners[0]!, center))).toBeCloseTo(0, 6);
  });
  it("on the sphere are under the pointer, and on its rim beside it", () => {
    expect(onSphere(0.3, -0.4, false)[2]).toBeLessThan(0);
    expect(length(onSphere(0.3, -0.4, true))).toBeCloseTo(1, 12);
    expect(onSphere(3, 4, true)).toEqual([0.6, 0.8, 0]);
  });
});

describe("the scale bar", () => {
  it("is 1, 2 or 5 times a power of ten, and never longer than its room", () => {
    for (const room of [0.0123, 0.5, 1, 4.99, 19.9, 99, 731]) {
      const { mm } = niceLength(room);
      expect(mm).toBeLessThanOrEqual(room * (1 + 1e-9));
      expect(mm).toBeGreaterThan(room / 2.51);
    }
  });
  it("names lengths in the largest unit of which there is one", () => {
    expect([2e-5, 0.001, 0.02, 5, 20, 500, 2000].map(formatRoundLength)).toEqual(["20 nm", "1 µm", "20 µm", "5 mm", "2 cm", "50 cm", "2 m"]);
  });
});

describe("a picture of another shape", () => {
  it("lies in the middle of the view, as large as fits", () => {
    expect(letterbox([100, 100], { width: 400, height: 200 })).toEqual({ x: 100, y: 0, width: 200, height: 200 });
    expect(letterbox([300, 100], { width: 150, height: 200 })).toEqual({ x: 0, y: 75, width: 150, height: 50 });
  });
});
