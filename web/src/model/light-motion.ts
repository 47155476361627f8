import { add, length, scale, sub } from "../geometry/vec3";
import type { FieldValue, Light, Track, Vec3 } from "../state/scene-types";
import { anglesOf, directionOf, type Angles } from "./angles";

/** Where a light stands, seen from the target; distance 0 of a directional one. */
export interface LightPlace extends Angles {
  distanceMm: number;
}

/** From the target to the light, in the light's own frame. */
function offsetOf(light: Light, target: Vec3): Vec3 {
  if (light.kind === "directional") return light.direction ?? [0, 0, 1];
  const position = light.position_mm ?? [0, 0, 0];
  return light.attached_to === "world" ? sub(position, target) : position;
}

export function placeOf(light: Light, target: Vec3): LightPlace {
  const offset = offsetOf(light, target);
  return { ...anglesOf(offset, light.attached_to), distanceMm: light.kind === "directional" ? 0 : length(offset) };
}

/** The field that says where a light of this kind is, and its value for a place. */
export function placed(
  light: Light,
  place: LightPlace,
  target: Vec3,
): { field: "direction" | "position_mm"; value: Vec3 } {
  const direction = directionOf(place, light.attached_to);
  if (light.kind === "directional") return { field: "direction", value: direction };
  const offset = scale(direction, place.distanceMm);
  return { field: "position_mm", value: light.attached_to === "world" ? add(target, offset) : offset };
}

export function orbited(light: Light, target: Vec3, byDeg: number) {
  const place = placeOf(light, target);
  return placed(light, { ...place, azimuthDeg: place.azimuthDeg + byDeg }, target);
}

/** Share of the intensity that a flashing light keeps when it is darkest. */
export const flashLowest = 0.1;

/** Of the intensity at `share` of a period: begins at 1. */
export function flashFactor(share: number): number {
  return flashLowest + (1 - flashLowest) * (0.5 + 0.5 * Math.cos(2 * Math.PI * share));
}

/** Keys of a turn: positions are joined by straight lines, which leave the circle by 1 % at most. */
const keysOfTurn = 24;

/** Once around the target in `seconds`. */
export function orbitTrack(light: Light, index: number, target: Vec3, seconds: number): Track {
  const keys = Array.from({ length: keysOfTurn + 1 }, (_, i): [number, FieldValue] => {
    const share = i / keysOfTurn;
    return [Number((share * seconds).toFixed(4)), [...orbited(light, target, 360 * share).value]];
  });
  return { field: `/lights/${index}/${orbited(light, target, 0).field}`, interpolation: "linear", keys };
}

/** Dark and bright again in `seconds`. */
export function flashTrack(light: Light, index: number, seconds: number): Track {
  return {
    field: `/lights/${index}/intensity`,
    interpolation: "smooth",
    keys: [
      [0, light.intensity],
      [seconds / 2, light.intensity * flashLowest],
      [seconds, light.intensity],
    ],
  };
}
