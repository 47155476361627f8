import type { FrameCamera } from "../state/protocol";
import { add, cross, dot, normalize, scale, sub, type Vec3 } from "./vec3";

/** Where points are seen and what places of the picture look at. Picture coordinates run from (0, 0), the top left
 * corner, to (1, 1). The camera is that of a frame's header, so that what is drawn over a picture fits it. */

export interface PicturePoint {
  x: number;
  y: number;
  /** Along the viewing axis; a perspective camera sees only what is > 0. */
  depth_mm: number;
}

export interface Ray {
  origin: Vec3;
  /** Unit. */
  direction: Vec3;
}

export function project(camera: FrameCamera, p_mm: Vec3): PicturePoint {
  const fromEye = sub(p_mm, camera.eye_mm);
  const depth_mm = dot(fromEye, camera.forward);
  const perspective = camera.orthographic ? 1 : 1 / depth_mm;
  const right = (dot(fromEye, camera.right) * perspective) / camera.half_width;
  const up = (dot(fromEye, camera.up) * perspective) / camera.half_height;
  return { x: 0.5 * (1 + right), y: 0.5 * (1 - up), depth_mm };
}

export function ray(camera: FrameCamera, x: number, y: number): Ray {
  const offset = add(
    scale(camera.right, (2 * x - 1) * camera.half_width),
    scale(camera.up, (1 - 2 * y) * camera.half_height),
  );
  if (camera.orthographic) return { origin: add(camera.eye_mm, offset), direction: camera.forward };
  return { origin: camera.eye_mm, direction: normalize(add(camera.forward, offset)) };
}

/** The point at picture place (x, y) in the plane that faces the camera at `depth_mm`. */
export function pointAtDepth(camera: FrameCamera, x: number, y: number, depth_mm: number): Vec3 {
  const from = ray(camera, x, y);
  if (camera.orthographic) return add(from.origin, scale(from.direction, depth_mm));
  return add(from.origin, scale(from.direction, depth_mm / dot(from.direction, camera.forward)));
}

/** mm that a picture's whole height covers in the plane at `depth_mm`. */
export function heightAtDepth_mm(camera: FrameCamera, depth_mm: number): number {
  return 2 * camera.half_height * (camera.orthographic ? 1 : depth_mm);
}

/** Where along the line `origin + t axis` (axis unit) it is nearest to a ray: t. Null where they are parallel. */
export function nearestOnLine(origin: Vec3, axis: Vec3, seen: Ray): number | null {
  const across = cross(axis, seen.direction);
  const sine2 = dot(across, across);
  if (sine2 < 1e-6) return null;
  return dot(cross(sub(seen.origin, origin), seen.direction), across) / sine2;
}
