import type { Camera } from "../state/scene-types";
import { add, cross, dot, length, normalize, scale, sub, type Vec3 } from "./vec3";

/** How a scene's camera stands, and the same camera moved. The conventions are those of docs/scene-reference.md: at
 * azimuth and elevation 0 the eye looks at the patient's face; azimuth grows toward the left, elevation toward the
 * head; roll turns the camera clockwise. */

const kRadians = Math.PI / 180;
const kZoomRange = [0.02, 500] as const;

export interface Axes {
  right: Vec3;
  up: Vec3;
  forward: Vec3;
}

/** What the scene leaves open: where the camera looks when it has no target, and the picture's shape. */
export interface Surroundings {
  center_mm: Vec3;
  radius_mm: number;
  /** Width by height of the picture. */
  aspect: number;
}

/** From the target to the eye, and the picture's up before roll. */
function level(azimuth_deg: number, elevation_deg: number): { towardEye: Vec3; up: Vec3 } {
  const az = azimuth_deg * kRadians;
  const el = elevation_deg * kRadians;
  return {
    towardEye: [Math.cos(el) * Math.sin(az), -Math.cos(el) * Math.cos(az), Math.sin(el)],
    up: [-Math.sin(el) * Math.sin(az), Math.sin(el) * Math.cos(az), Math.cos(el)],
  };
}

function rolled(forward: Vec3, up: Vec3, roll_deg: number): Axes {
  const right0 = normalize(cross(forward, up));
  const up0 = cross(right0, forward);
  const c = Math.cos(roll_deg * kRadians);
  const s = Math.sin(roll_deg * kRadians);
  return {
    right: sub(scale(right0, c), scale(up0, s)),
    up: add(scale(up0, c), scale(right0, s)),
    forward,
  };
}

export function targetOf(camera: Camera, around: Surroundings): Vec3 {
  return camera.target_mm ?? around.center_mm;
}

export function axesOf(camera: Camera, around: Surroundings): Axes {
  if (!camera.eye_mm) {
    const { towardEye, up } = level(camera.azimuth_deg, camera.elevation_deg);
    return rolled(scale(towardEye, -1), up, camera.roll_deg);
  }
  const forward = normalize(sub(targetOf(camera, around), camera.eye_mm));
  let up = camera.up ?? ([0, 0, 1] as const);
  if (length(cross(forward, up)) <= 1e-6 * length(up)) up = [0, forward[2] < 0 ? 1 : -1, 0];
  return rolled(forward, up, camera.roll_deg);
}

/** From the eye to the target at zoom 1 [mm]; of a perspective camera. */
function fitDistance_mm(camera: Camera, around: Surroundings): number {
  const smaller = Math.min(1, around.aspect) * Math.tan(0.5 * camera.vertical_fov_deg * kRadians);
  return (camera.fit_radius_mm ?? around.radius_mm) / Math.sin(Math.atan(smaller));
}

/** mm that the picture's height covers at the target. */
export function heightAtTarget_mm(camera: Camera, around: Surroundings): number {
  if (camera.projection === "orthographic") {
    if (camera.height_mm !== undefined) return camera.height_mm;
    return (2 * (camera.fit_radius_mm ?? around.radius_mm)) / Math.min(1, around.aspect) / camera.zoom;
  }
  const distance = camera.eye_mm
    ? length(sub(camera.eye_mm, targetOf(camera, around)))
    : fitDistance_mm(camera, around) / camera.zoom;
  return 2 * Math.tan(0.5 * camera.vertical_fov_deg * kRadians) * distance;
}

/** Degrees in (-180, 180]. */
export function wrapped(angle_deg: number): number {
  const turn = ((angle_deg % 360) + 360) % 360;
  return turn > 180 ? turn - 360 : turn;
}

/** The same view by angles and zoom, where it was given by eye_mm. */
export function byAngles(camera: Camera, around: Surroundings): Camera {
  if (!camera.eye_mm) return camera;
  const target = targetOf(camera, around);
  const axes = axesOf(camera, around);
  const towardEye = scale(axes.forward, -1);
  const elevation_deg = Math.asin(Math.min(1, Math.max(-1, towardEye[2]))) / kRadians;
  const atPole = Math.hypot(towardEye[0], towardEye[1]) < 1e-6;
  const azimuth_deg = atPole ? 0 : Math.atan2(towardEye[0], -towardEye[1]) / kRadians;
  const unrolled = rolled(axes.forward, level(azimuth_deg, elevation_deg).up, 0);
  const roll_deg = Math.atan2(dot(axes.up, unrolled.right), dot(axes.up, unrolled.up)) / kRadians;
  const { eye_mm, up: _, ...rest } = camera;
  const zoom =
    camera.projection === "orthographic" ? camera.zoom : fitDistance_mm(camera, around) / length(sub(eye_mm, target));
  return { ...rest, azimuth_deg, elevation_deg, roll_deg, zoom, target_mm: target };
}

/** Turned around the target, so that what is nearest follows a drag of (right_deg, up_deg) on the screen. */
export function orbited(camera: Camera, around: Surroundings, right_deg: number, up_deg: number): Camera {
  const from = byAngles(camera, around);
  const c = Math.cos(from.roll_deg * kRadians);
  const s = Math.sin(from.roll_deg * kRadians);
  const across = right_deg * c + up_deg * s;
  const upward = -right_deg * s + up_deg * c;
  return {
    ...from,
    azimuth_deg: wrapped(from.azimuth_deg - across),
    elevation_deg: Math.min(90, Math.max(-90, from.elevation_deg - upward)),
  };
}

/** Moved sideways, so that what is at the target's depth follows a drag of (right_mm, up_mm). */
export function panned(camera: Camera, around: Surroundings, right_mm: number, up_mm: number): Camera {
  const from = byAngles(camera, around);
  const axes = axesOf(from, around);
  const by = add(scale(axes.right, -right_mm), scale(axes.up, -up_mm));
  return { ...from, target_mm: add(targetOf(from, around), by) };
}

/** Nearer by `factor` (> 1), or farther. */
export function zoomed(camera: Camera, around: Surroundings, factor: number): Camera {
  const from = byAngles(camera, around);
  const zoom = Math.min(kZoomRange[1], Math.max(kZoomRange[0], from.zoom * factor));
  if (from.projection === "orthographic" && from.height_mm !== undefined)
    return { ...from, height_mm: from.height_mm / factor };
  return { ...from, zoom };
}

/** The picture turned clockwise. */
export function turned(camera: Camera, around: Surroundings, clockwise_deg: number): Camera {
  const from = byAngles(camera, around);
  return { ...from, roll_deg: wrapped(from.roll_deg - clockwise_deg) };
}

/** Between two cameras by angles: angles go the shorter way, zoom by equal ratios. t in [0, 1]. */
export function between(from: Camera, to: Camera, t: number, around: Surroundings): Camera {
  const mix = (a: number, b: number) => a + (b - a) * t;
  const turn = (a: number, b: number) => wrapped(a + wrapped(b - a) * t);
  const a = targetOf(from, around);
  const b = targetOf(to, around);
  return {
    ...to,
    azimuth_deg: turn(from.azimuth_deg, to.azimuth_deg),
    elevation_deg: mix(from.elevation_deg, to.elevation_deg),
    roll_deg: turn(from.roll_deg, to.roll_deg),
    zoom: from.zoom * (to.zoom / from.zoom) ** t,
    target_mm: [mix(a[0], b[0]), mix(a[1], b[1]), mix(a[2], b[2])],
  };
}
