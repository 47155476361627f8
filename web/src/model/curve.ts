import type { Span } from "./axis";
import type { TransferPoint, Vec3 } from "../state/scene-types";
import { linear } from "../color";
import { mix } from "../geometry/vec3";

/** Coefficients that are one number. */
export type NumberKey =
  "opacity" | "mu_t_per_mm" | "roughness" | "metallic" | "specular" | "anisotropy" | "surface_share";
export type ColorKey = "color" | "emission" | "extinction_color";

export const numberKeys: readonly NumberKey[] = [
  "opacity",
  "mu_t_per_mm",
  "roughness",
  "metallic",
  "specular",
  "anisotropy",
  "surface_share",
];
export const colorKeys: readonly ColorKey[] = ["color", "emission", "extinction_color"];

/** Opacity above which the renderer does not tell matter apart. */
const mostOpacity = 0.9999;

export function opacityOfExtinction(muT: number, referenceMm: number): number {
  return 1 - Math.exp(-muT * referenceMm);
}

export function extinctionOfOpacity(opacity: number, referenceMm: number): number {
  return -Math.log1p(-Math.min(opacity, mostOpacity)) / referenceMm;
}

/** Whether the function is written in extinctions, not in opacities. */
export function usesExtinction(points: readonly TransferPoint[]): boolean {
  return points.some((p) => p.mu_t_per_mm !== undefined);
}

/** Opacity of a point where it gives one. */
export function pointOpacity(point: TransferPoint, referenceMm: number): number | undefined {
  return point.mu_t_per_mm === undefined ? point.opacity : opacityOfExtinction(point.mu_t_per_mm, referenceMm);
}

/** `point` with an opacity, written as the function writes it. */
export function withOpacity(
  point: TransferPoint,
  opacity: number,
  extinction: boolean,
  referenceMm: number,
): TransferPoint {
  const o = clamp(opacity, 0, 1);
  return extinction ? { ...point, mu_t_per_mm: extinctionOfOpacity(o, referenceMm) } : { ...point, opacity: o };
}

/** Linear between the points that have `of`, constant beyond them; at a step what is above it. Undefined where none has it. */
function between<T>(
  points: readonly TransferPoint[],
  value: number,
  of: (p: TransferPoint) => T | undefined,
  mix: (a: T, b: T, share: number) => T,
): T | undefined {
  let before: { value: number; is: T } | undefined;
  for (const p of points) {
    const is = of(p);
    if (is === undefined) continue;
    if (p.value > value) return before ? mix(before.is, is, (value - before.value) / (p.value - before.value)) : is;
    before = { value: p.value, is };
  }
  return before?.is;
}

const mixNumbers = (a: number, b: number, share: number) => a + (b - a) * share;

export function numberAt(points: readonly TransferPoint[], value: number, key: NumberKey): number | undefined {
  return between(points, value, (p) => p[key], mixNumbers);
}

export function colorAt(points: readonly TransferPoint[], value: number, key: ColorKey = "color"): Vec3 | undefined {
  return between(points, value, (p) => (p[key] === undefined ? undefined : linear(p[key]!)), mix);
}

/** Opacity of a reference length at `value`; 0 without points. */
export function opacityAt(points: readonly TransferPoint[], value: number, referenceMm: number): number {
  if (!usesExtinction(points)) return numberAt(points, value, "opacity") ?? 0;
  return opacityOfExtinction(numberAt(points, value, "mu_t_per_mm") ?? 0, referenceMm);
}

/** Coefficients that the function has at `value`, as a point there. */
export function sampleAt(points: readonly TransferPoint[], value: number): TransferPoint {
  const point: TransferPoint = { value };
  for (const key of numberKeys) {
    const number = numberAt(points, value, key);
    if (number !== undefined) point[key] = number;
  }
  for (const key of colorKeys) {
    const color = colorAt(points, value, key);
    if (color) point[key] = { linear: color };
  }
  return point;
}

/** What an edit made of the points, and where the point it was about is now. */
export interface EditedPoints {
  points: TransferPoint[];
  selected: number;
}

/** Adds a point that leaves every other coefficient's curve as it is. */
export function addPoint(
  points: readonly TransferPoint[],
  value: number,
  opacity: number,
  referenceMm: number,
): EditedPoints {
  const sampled = points.length ? sampleAt(points, value) : { value, color: "#e6e6e6" };
  const added = withOpacity(sampled, opacity, usesExtinction(points), referenceMm);
  const at = points.findIndex((p) => p.value > value);
  const selected = at < 0 ? points.length : at;
  return { points: [...points.slice(0, selected), added, ...points.slice(selected)], selected };
}

export function removePoint(points: readonly TransferPoint[], index: number): EditedPoints {
  const left = points.filter((_, i) => i !== index);
  return { points: left, selected: Math.min(index, left.length - 1) };
}

export function replacePoint(points: readonly TransferPoint[], index: number, point: TransferPoint): TransferPoint[] {
  return points.map((p, i) => (i === index ? point : p));
}

/**
 * Moves a point. It stops at its neighbours, where it makes a step: points stay sorted, and the one that is dragged stays the
 * same.
 */
export function movePoint(
  points: readonly TransferPoint[],
  index: number,
  value: number,
  limits: Span,
): TransferPoint[] {
  const lo = index > 0 ? points[index - 1]!.value : Math.min(limits.lo, points[index]!.value);
  const hi = index + 1 < points.length ? points[index + 1]!.value : Math.max(limits.hi, points[index]!.value);
  return replacePoint(points, index, { ...points[index]!, value: clamp(value, lo, hi) });
}

/** All points moved by `by` data units. */
export function shiftPoints(points: readonly TransferPoint[], by: number): TransferPoint[] {
  return points.map((p) => ({ ...p, value: p.value + by }));
}

/** `point` with a coefficient set, or without it (undefined): the curve then passes by. */
export function withCoefficient<K extends NumberKey | ColorKey | "material">(
  point: TransferPoint,
  key: K,
  is: TransferPoint[K] | undefined,
): TransferPoint {
  const { [key]: _, ...rest } = point;
  return is === undefined ? (rest as TransferPoint) : { ...(rest as TransferPoint), [key]: is };
}

export function clamp(x: number, lo: number, hi: number): number {
  return Math.min(hi, Math.max(lo, x));
}
