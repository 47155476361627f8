import type { Light } from "../state/scene-types";
import { add, cross, dot, length, normalize, scale, sub, type Vec3 } from "./vec3";

/** Lights in world space, and moved. A light attached to the camera is given by its (right, up, toward the eye). */

export interface CameraFrame {
  target_mm: Vec3;
  right: Vec3;
  up: Vec3;
  forward: Vec3;
}

function directionToWorld(v: Vec3, camera: CameraFrame): Vec3 {
  return add(add(scale(camera.right, v[0]), scale(camera.up, v[1])), scale(camera.forward, -v[2]));
}

function directionFromWorld(v: Vec3, camera: CameraFrame): Vec3 {
  return [dot(v, camera.right), dot(v, camera.up), -dot(v, camera.forward)];
}

/** Unit vector from the scene to a directional light. */
export function worldDirection(light: Light, camera: CameraFrame): Vec3 {
  const given = light.direction ?? [0, 0, 1];
  return normalize(light.attached_to === "camera" ? directionToWorld(given, camera) : given);
}

/** The `direction` field of a light that shines from the unit vector `world`. */
export function directionField(light: Light, world: Vec3, camera: CameraFrame): Vec3 {
  return light.attached_to === "camera" ? directionFromWorld(world, camera) : world;
}

/** Where a point or rect light is [LPS mm]. */
export function worldPosition(light: Light, camera: CameraFrame): Vec3 {
  const given = light.position_mm ?? [0, 0, 0];
  return light.attached_to === "camera" ? add(camera.target_mm, directionToWorld(given, camera)) : given;
}

/** The `position_mm` field of a light that is at `world_mm`. */
export function positionField(light: Light, world_mm: Vec3, camera: CameraFrame): Vec3 {
  if (light.attached_to !== "camera") return world_mm;
  return directionFromWorld(sub(world_mm, camera.target_mm), camera);
}

/** The point that a rect light faces [LPS mm]. */
export function facedPoint(light: Light, camera: CameraFrame): Vec3 {
  if (!light.target_mm) return camera.target_mm;
  if (light.attached_to !== "camera") return light.target_mm;
  return add(camera.target_mm, directionToWorld(light.target_mm, camera));
}

/** The corners of a rect light [LPS mm], in order around it. */
export function rectCorners(light: Light, camera: CameraFrame): Vec3[] {
  const center = worldPosition(light, camera);
  const normal = normalize(sub(facedPoint(light, camera), center));
  const inCamera = light.attached_to === "camera";
  let up: Vec3 = inCamera ? camera.up : [0, 0, 1];
  if (light.up) up = inCamera ? directionToWorld(light.up, camera) : light.up;
  if (length(cross(normal, up)) < 1e-3 * length(up)) up = camera.up;
  const across = normalize(cross(normal, up));
  const upright = cross(across, normal);
  const [width, height] = light.size_mm;
  return (
    [
      [1, 1],
      [-1, 1],
      [-1, -1],
      [1, -1],
    ] as const
  ).map(([a, b]) => add(center, add(scale(across, (a * width) / 2), scale(upright, (b * height) / 2))));
}

/** The point of the unit sphere that is seen at (x, y), x right and y up, of the side toward the eye or of the other;
 * beside the sphere the nearest point of its rim. In (right, up, toward the eye). */
export function onSphere(x: number, y: number, front: boolean): Vec3 {
  const r = Math.hypot(x, y);
  if (r >= 1) return [x / r, y / r, 0];
  const z = Math.sqrt(1 - r * r);
  return [x, y, front ? z : -z];
}
