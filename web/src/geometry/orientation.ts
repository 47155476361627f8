import type { Vec3 } from "./vec3";

/** Patient directions: +x left, +y posterior, +z head (LPS). */
export const directions: { letter: string; name: string; vector: Vec3 }[] = [
  { letter: "L", name: "left", vector: [1, 0, 0] },
  { letter: "R", name: "right", vector: [-1, 0, 0] },
  { letter: "P", name: "posterior", vector: [0, 1, 0] },
  { letter: "A", name: "anterior", vector: [0, -1, 0] },
  { letter: "S", name: "superior", vector: [0, 0, 1] },
  { letter: "I", name: "inferior", vector: [0, 0, -1] },
];

/** The letters of the patient directions that `v` (unit) points to, the strongest first: "L", "LA", "SLP". A part
 * below about 23 degrees from a plane is left out. */
export function orientationLabel(v: Vec3): string {
  const letters: [number, string][] = [
    [v[0], v[0] > 0 ? "L" : "R"],
    [v[1], v[1] > 0 ? "P" : "A"],
    [v[2], v[2] > 0 ? "S" : "I"],
  ];
  return letters
    .filter(([part]) => Math.abs(part) > 0.38)
    .sort((a, b) => Math.abs(b[0]) - Math.abs(a[0]))
    .map(([, letter]) => letter)
    .join("");
}

export type Axis = 0 | 1 | 2;

/** Letters of the sides that the LPS axes come from and go to. */
const sides = [
  ["R", "L"],
  ["A", "P"],
  ["I", "S"],
] as const;

/** A coordinate [LPS mm] by the patient's side, without a sign: "R 12.5". What rounds to 0 is "L 0.0", "P 0.0" or
 * "S 0.0". */
export function formatCoordinate(axis: Axis, mm: number): string {
  const rounded = Number(mm.toFixed(1));
  return `${sides[axis][rounded < 0 ? 0 : 1]} ${Math.abs(rounded).toFixed(1)}`;
}

/** A position [LPS mm]: "R 12.5  P 0.0  S 40.2 mm". */
export function formatPosition(p: Vec3): string {
  return `${p.map((mm, axis) => formatCoordinate(axis as Axis, mm)).join("  ")} mm`;
}

/** The coordinate that was typed, as "R 12.5" or as a number of LPS; NaN where it is neither. */
export function parseCoordinate(axis: Axis, text: string): number {
  const parts = /^\s*([a-z]?)\s*([-+]?[\d.,]+)\s*$/i.exec(text);
  if (!parts) return NaN;
  const mm = Number(parts[2]!.replace(",", "."));
  const letter = parts[1]!.toUpperCase();
  if (letter === "") return mm;
  const side = sides[axis].findIndex((one) => one === letter);
  return side < 0 ? NaN : side === 0 ? -mm : mm;
}
