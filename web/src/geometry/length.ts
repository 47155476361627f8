import type { Axis } from "./orientation";
import type { Vec3 } from "./vec3";

/** How lengths and places are written: in the unit and with the digits that suit a volume's voxels. */

export interface LengthScale {
  unit: "nm" | "µm" | "mm" | "m";
  /** Of one unit. */
  mm: number;
  /** After the point, of places and of lengths below 100 units. */
  digits: number;
}

/** Units, and the voxels' side that each begins with: with fewer than 4 digits after the point. */
const units = [
  { unit: "m", mm: 1000, from_mm: 100 },
  { unit: "mm", mm: 1, from_mm: 0.01 },
  { unit: "µm", mm: 1e-3, from_mm: 1e-5 },
  { unit: "nm", mm: 1e-6, from_mm: 0 },
] as const;

/** Digits after the point that tell a quarter of a voxel; at least one, but of voxels of 10 units and more. */
function resolvingDigits(voxel: number): number {
  return voxel < 10 ? Math.max(1, Math.ceil(-Math.log10(voxel / 4))) : 0;
}

/** For voxels of this side. */
export function lengthScale(voxel_mm: number): LengthScale {
  const { unit, mm } = units.find(({ from_mm }) => voxel_mm >= from_mm * (1 - 1e-6))!;
  return { unit, mm, digits: resolvingDigits(voxel_mm / mm) };
}

/** For voxels of this side, where mm are wanted. */
export function scaleInMm(voxel_mm: number): LengthScale {
  return { unit: "mm", mm: 1, digits: resolvingDigits(voxel_mm) };
}

/** Letters of the sides that the LPS axes come from and go to. */
const sides = [
  ["R", "L"],
  ["A", "P"],
  ["I", "S"],
] as const;

/** A coordinate [LPS mm] by the patient's side, without sign and unit: "R 12.5". What rounds to 0 is "L 0.0", "P 0.0"
 * or "S 0.0". */
export function formatCoordinate(axis: Axis, mm: number, scale: LengthScale): string {
  const rounded = Number((mm / scale.mm).toFixed(scale.digits));
  return `${sides[axis][rounded < 0 ? 0 : 1]} ${Math.abs(rounded).toFixed(scale.digits)}`;
}

/** A plane [LPS mm]: "R 12.5 mm". */
export function formatPlace(axis: Axis, mm: number, scale: LengthScale): string {
  return `${formatCoordinate(axis, mm, scale)} ${scale.unit}`;
}

/** A position [LPS mm]: "R 12.5  P 0.0  S 40.2 mm". */
export function formatPosition(p: Vec3, scale: LengthScale): string {
  return `${p.map((mm, axis) => formatCoordinate(axis as Axis, mm, scale)).join("  ")} ${scale.unit}`;
}

/** A measured length: "12.5 mm", and from 100 on without digits after the point. */
export function formatDistance(mm: number, scale: LengthScale): string {
  const length = mm / scale.mm;
  return `${length.toFixed(length >= 100 ? 0 : scale.digits)} ${scale.unit}`;
}

/** The coordinate [LPS mm] that was typed, as "R 12.5" or as a number of LPS; NaN where it is neither. */
export function parseCoordinate(axis: Axis, text: string): number {
  const parts = /^\s*([a-z]?)\s*([-+]?[\d.,]+(?:e[-+]?\d+)?)\s*$/i.exec(text);
  if (!parts) return NaN;
  const mm = Number(parts[2]!.replace(",", "."));
  const letter = parts[1]!.toUpperCase();
  if (letter === "") return mm;
  const side = sides[axis].findIndex((one) => one === letter);
  return side < 0 ? NaN : side === 0 ? -mm : mm;
}

/** The longest of 1, 2, 5 times a power of ten [mm] that is at most `longest_mm`, and how it is written. */
export function niceLength(longest_mm: number): { mm: number; label: string } {
  const power = 10 ** Math.floor(Math.log10(longest_mm));
  const digit = [5, 2, 1].find((d) => d * power <= longest_mm * (1 + 1e-9)) ?? 1;
  const mm = digit * power;
  return { mm, label: formatRoundLength(mm) };
}

/** "2 cm", "5 mm", "20 µm": the largest unit in which it is 1 or more. */
export function formatRoundLength(mm: number): string {
  const tidy = (x: number) => String(Number(x.toPrecision(6)));
  if (mm >= 1000) return `${tidy(mm / 1000)} m`;
  if (mm >= 10) return `${tidy(mm / 10)} cm`;
  if (mm >= 1) return `${tidy(mm)} mm`;
  return mm >= 0.9999e-3 ? `${tidy(mm * 1000)} µm` : `${tidy(mm * 1e6)} nm`;
}
