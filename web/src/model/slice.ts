import type { Axis } from "../geometry/orientation";
import type { Vec3 } from "../state/scene-types";

export type Plane = "axial" | "coronal" | "sagittal";

/**
 * How a plane of LPS space lies on the screen, as radiologists look at it: axial from the feet, coronal from the front, sagittal
 * from the patient's left, head up.
 */
export interface PlaneLayout {
  title: string;
  /** The axis that the plane is across, as /api/slice calls it, and its number. */
  axis: "x" | "y" | "z";
  normal: Axis;
  /** Numbers of the axes along columns (to the right) and rows. */
  across: 0 | 1;
  along: 1 | 2;
  /** Whether rows are shown from the last to the first: they grow toward the head, which is up. */
  flipped: boolean;
  letters: { left: string; right: string; top: string; bottom: string };
}

export const planes: Record<Plane, PlaneLayout> = {
  axial: {
    title: "Axial",
    axis: "z",
    normal: 2,
    across: 0,
    along: 1,
    flipped: false,
    letters: { left: "R", right: "L", top: "A", bottom: "P" },
  },
  coronal: {
    title: "Coronal",
    axis: "y",
    normal: 1,
    across: 0,
    along: 2,
    flipped: true,
    letters: { left: "R", right: "L", top: "S", bottom: "I" },
  },
  sagittal: {
    title: "Sagittal",
    axis: "x",
    normal: 0,
    across: 1,
    along: 2,
    flipped: true,
    letters: { left: "A", right: "P", top: "S", bottom: "I" },
  },
};
export const planeNames: readonly Plane[] = ["axial", "coronal", "sagittal"];

/** Header of /api/slice: a grid of samples of one spacing; origin_mm is where the first one's centre is. */
export interface SliceHeader {
  width: number;
  height: number;
  origin_mm: [number, number];
  spacing_mm: number;
  scale: number;
  offset: number;
}

/** Where samples lie on a canvas: a rectangle in pixels, every sample a square of `zoom` pixels. */
export interface SlicePlacement {
  left: number;
  top: number;
  zoom: number;
}

/** The slice as large as fits, in the middle. */
export function fitSlice(header: SliceHeader, width: number, height: number): SlicePlacement {
  const zoom = Math.min(width / header.width, height / header.height);
  return { left: (width - zoom * header.width) / 2, top: (height - zoom * header.height) / 2, zoom };
}

/** The place on the canvas of a point of LPS space, moved into the plane. */
export function canvasOf(
  layout: PlaneLayout,
  header: SliceHeader,
  placement: SlicePlacement,
  p: Vec3,
): [number, number] {
  const column = (p[layout.across] - header.origin_mm[0]) / header.spacing_mm + 0.5;
  const row = (p[layout.along] - header.origin_mm[1]) / header.spacing_mm + 0.5;
  return [
    placement.left + placement.zoom * column,
    placement.top + placement.zoom * (layout.flipped ? header.height - row : row),
  ];
}

/** The point of the plane `at_mm` that is seen at a place of the canvas. */
export function pointOf(
  layout: PlaneLayout,
  header: SliceHeader,
  placement: SlicePlacement,
  atMm: number,
  x: number,
  y: number,
): Vec3 {
  const column = (x - placement.left) / placement.zoom;
  const shown = (y - placement.top) / placement.zoom;
  const row = layout.flipped ? header.height - shown : shown;
  const p: [number, number, number] = [0, 0, 0];
  p[layout.normal] = atMm;
  p[layout.across] = header.origin_mm[0] + header.spacing_mm * (column - 0.5);
  p[layout.along] = header.origin_mm[1] + header.spacing_mm * (row - 0.5);
  return p;
}
