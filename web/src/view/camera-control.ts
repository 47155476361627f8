import {
  axesOf,
  between,
  byAngles,
  heightAtTarget_mm,
  orbited,
  panned,
  targetOf,
  turned,
  zoomed,
  type Surroundings,
} from "../geometry/orbit";
import { distance, mix, type Vec3 } from "../geometry/vec3";
import type { Assignment } from "../state/protocol";
import type { Camera, Faces, Range, Scene } from "../state/scene-types";
import { edit, newGesture, scene } from "../state/scene";
import { volume } from "../state/volume";
import { letterbox, viewSize } from "./overlay";

/** Moves the scene's camera. Everything here does nothing while no scene is open. */

/** The box that is kept: the volume's, cut by the clip box. */
export function visibleBox_mm(of: Scene): readonly [Vec3, Vec3] {
  const [low, high] = volume.value?.bounds_mm ?? [[-100, -100, -100] as const, [100, 100, 100] as const];
  if (!of.clip) return [low, high];
  const sides: Faces[] = [of.clip.x_mm, of.clip.y_mm, of.clip.z_mm];
  const cut = (axis: number): Range => {
    const [from, to] = sides[axis]!;
    return [Math.max(low[axis]!, from ?? -Infinity), Math.min(high[axis]!, to ?? Infinity)];
  };
  const [x, y, z] = [cut(0), cut(1), cut(2)];
  return [
    [x[0], y[0], z[0]],
    [x[1], y[1], z[1]],
  ];
}

function surroundings(of: Scene): Surroundings {
  const [low, high] = visibleBox_mm(of);
  return {
    center_mm: mix(low, high, 0.5),
    radius_mm: 0.5 * distance(low, high),
    aspect: of.image.width / of.image.height,
  };
}

/** What changed of a camera, as edits. */
function changes(from: Camera, to: Camera): Assignment[] {
  const before = from as unknown as Record<string, unknown>;
  const after = to as unknown as Record<string, unknown>;
  const names = new Set([...Object.keys(before), ...Object.keys(after)]);
  return [...names]
    .filter((name) => before[name] !== after[name])
    .map((name) => [`/camera/${name}`, after[name] ?? null] as const);
}

type Move = (camera: Camera, around: Surroundings) => Camera;

function move(by: Move, gesture: string): void {
  const now = scene.peek();
  if (now) edit(changes(now.camera, by(now.camera, surroundings(now))), gesture);
}

/** Ends a flight, when the user takes the camera. */
let flight = 0;
const kFlight_ms = 320;

function fly(by: Move, what: string): void {
  const now = scene.peek();
  if (!now) return;
  const gesture = newGesture(what);
  const around = surroundings(now);
  const from = byAngles(now.camera, around);
  const to = by(from, around);
  const number = ++flight;
  if (matchMedia("(prefers-reduced-motion: reduce)").matches) return move(() => to, gesture);
  const start_ms = performance.now();
  const step = (time_ms: number) => {
    if (number !== flight || !scene.peek()) return;
    const t = Math.min(1, Math.max(0, (time_ms - start_ms) / kFlight_ms));
    const eased = t * t * (3 - 2 * t);
    move(() => (t === 1 ? to : between(from, to, eased, around)), gesture);
    if (t < 1) requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}

const kDegreesPerHeight = 220;

/** Orbits by a drag [CSS px]. */
export function orbitByPixels(dx: number, dy: number, gesture: string): void {
  flight++;
  const perPixel = kDegreesPerHeight / viewSize.peek().height;
  move((camera, around) => orbited(camera, around, dx * perPixel, -dy * perPixel), gesture);
}

/** Moves sideways by a drag [CSS px]. */
export function panByPixels(dx: number, dy: number, gesture: string): void {
  flight++;
  const now = scene.peek();
  if (!now) return;
  const rect = letterbox([now.image.width, now.image.height], viewSize.peek());
  const mm = heightAtTarget_mm(now.camera, surroundings(now)) / rect.height;
  move((camera, around) => panned(camera, around, dx * mm, -dy * mm), gesture);
}

export function zoomBy(factor: number, gesture: string): void {
  flight++;
  move((camera, around) => zoomed(camera, around, factor), gesture);
}

export function rollBy(clockwise_deg: number, gesture: string): void {
  flight++;
  move((camera, around) => turned(camera, around, clockwise_deg), gesture);
}

export function orbitBy(right_deg: number, up_deg: number, gesture: string): void {
  flight++;
  move((camera, around) => orbited(camera, around, right_deg, up_deg), gesture);
}

/** Views along the patient's axes; the letter is the side that is looked at. Keys 1 to 6 in this order. */
export const axisViews = [
  { letter: "A", name: "Anterior: from the front", azimuth_deg: 0, elevation_deg: 0 },
  { letter: "P", name: "Posterior: from the back", azimuth_deg: 180, elevation_deg: 0 },
  { letter: "L", name: "Left: from the patient's left", azimuth_deg: 90, elevation_deg: 0 },
  { letter: "R", name: "Right: from the patient's right", azimuth_deg: -90, elevation_deg: 0 },
  { letter: "S", name: "Superior: from the head", azimuth_deg: 0, elevation_deg: 90 },
  { letter: "I", name: "Inferior: from the feet", azimuth_deg: 0, elevation_deg: -90 },
] as const;

export function lookFrom(azimuth_deg: number, elevation_deg: number): void {
  fly((camera) => ({ ...camera, azimuth_deg, elevation_deg, roll_deg: 0 }), "axis-view");
}

/** All that is visible in the middle of the picture. */
export function fitView(): void {
  fly((camera, around) => {
    const { height_mm: _, ...rest } = camera;
    return { ...rest, zoom: 1, target_mm: around.center_mm, fit_radius_mm: around.radius_mm };
  }, "fit");
}

/** Orbits around this point from now on; it comes into the middle of the picture. */
export function setTarget(p_mm: Vec3): void {
  fly((camera) => ({ ...camera, target_mm: p_mm }), "target");
}

/** Changes between perspective and parallel rays; what is at the target keeps its size. */
export function toggleProjection(): void {
  const now = scene.peek();
  if (!now) return;
  const around = surroundings(now);
  const from = byAngles(now.camera, around);
  const { height_mm: _, ...to } = { ...from };
  to.projection = from.projection === "orthographic" ? "perspective" : "orthographic";
  const ratio = heightAtTarget_mm(to, around) / heightAtTarget_mm(from, around);
  edit(changes(now.camera, { ...to, zoom: to.zoom * ratio }));
}

/** The camera's target and axes as the scene has them now. */
export function cameraNow(): { target_mm: Vec3; right: Vec3; up: Vec3; forward: Vec3 } | null {
  const now = scene.value;
  if (!now) return null;
  const around = surroundings(now);
  return { target_mm: targetOf(now.camera, around), ...axesOf(now.camera, around) };
}
