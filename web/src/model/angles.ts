import type { Vec3 } from "../state/scene-types";

/** Turns about the target, as the camera's: 0, 0 is the patient's front (or the eye's side); azimuth grows toward the patient's left. */
export interface Angles {
  azimuthDeg: number;
  elevationDeg: number;
}

const degrees = 180 / Math.PI;

/** Unit vector to what stands at the angles: LPS, or (right, up, toward the eye) of what is attached to the camera. */
export function directionOf(angles: Angles, attachedTo: "world" | "camera"): Vec3 {
  const az = angles.azimuthDeg / degrees;
  const el = angles.elevationDeg / degrees;
  const aside = Math.sin(az) * Math.cos(el);
  const front = Math.cos(az) * Math.cos(el);
  return attachedTo === "world" ? [aside, -front, Math.sin(el)] : [aside, Math.sin(el), front];
}

/** Inverse of directionOf for vectors of any length; 0, 0 for none. Azimuth in (-180, 180]. */
export function anglesOf(v: Vec3, attachedTo: "world" | "camera"): Angles {
  const [aside, front, up] = attachedTo === "world" ? [v[0], -v[1], v[2]] : [v[0], v[2], v[1]];
  const flat = Math.hypot(aside, front);
  if (flat === 0 && up === 0) return { azimuthDeg: 0, elevationDeg: 0 };
  return {
    azimuthDeg: flat > 1e-9 * Math.abs(up) ? Math.atan2(aside, front) * degrees : 0,
    elevationDeg: Math.atan2(up, flat) * degrees,
  };
}

/** `angle` turned by whole circles into [-180, 180). */
export function wrapDegrees(angle: number): number {
  return angle - 360 * Math.floor((angle + 180) / 360);
}
