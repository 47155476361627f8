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
