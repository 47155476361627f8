import { describe, expect, it } from "vitest";
import { distance } from "../../src/geometry/vec3";
import {
  flashFactor,
  flashLowest,
  flashTrack,
  orbited,
  orbitTrack,
  placed,
  placeOf,
} from "../../src/model/light-motion";
import type { Light, Vec3 } from "../../src/state/scene-types";

const target: Vec3 = [10, 20, 30];
const rect: Light = {
  kind: "rect",
  attached_to: "world",
  color: "#ffffff",
  intensity: 5,
  position_mm: [10, -280, 130],
  size_mm: [100, 100],
  two_sided: false,
};
const sun: Light = {
  ...rect,
  kind: "directional",
  position_mm: undefined,
  direction: [0, 0, 2],
  attached_to: "camera",
};

describe("places of lights", () => {
  it("are angles and a distance from the target", () => {
    const place = placeOf(rect, target);
    expect(place.azimuthDeg).toBeCloseTo(0);
    expect(place.elevationDeg).toBeCloseTo(18.43, 1);
    expect(place.distanceMm).toBeCloseTo(Math.hypot(300, 100));
    placed(rect, place, target).value.forEach((x, i) => expect(x).toBeCloseTo(rect.position_mm![i]!));
  });

  it("of lights on the camera are relative to the target already", () => {
    const carried: Light = { ...rect, attached_to: "camera", position_mm: [0, 0, 400] };
    expect(placeOf(carried, target)).toEqual({ azimuthDeg: 0, elevationDeg: 0, distanceMm: 400 });
    expect(orbited(carried, target, 90).value[0]).toBeCloseTo(400);
  });

  it("of directional lights are directions", () => {
    expect(placed(sun, placeOf(sun, target), target)).toEqual({ field: "direction", value: [0, 0, 1] });
  });
});

describe("motion of lights as tracks", () => {
  it("goes around the target at one distance and closes", () => {
    const track = orbitTrack(rect, 2, target, 8);
    expect(track.field).toBe("/lights/2/position_mm");
    const places = track.keys.map(([, value]) => value as unknown as Vec3);
    for (const p of places) {
      expect(distance(p, target)).toBeCloseTo(Math.hypot(300, 100));
      expect(p[2]).toBeCloseTo(130);
    }
    places[0]!.forEach((x, i) => expect(places.at(-1)![i]).toBeCloseTo(x));
    expect(track.keys.at(-1)![0]).toBe(8);
  });

  it("flashes between the intensity and a tenth of it", () => {
    expect(flashFactor(0)).toBe(1);
    expect(flashFactor(0.5)).toBeCloseTo(flashLowest);
    expect(flashTrack(rect, 0, 2).keys).toEqual([
      [0, 5],
      [1, 0.5],
      [2, 5],
    ]);
  });
});
