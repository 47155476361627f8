import type { Axis } from "../geometry/orientation";
import { add, scale, sub } from "../geometry/vec3";
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

export interface Size {
  width: number;
  height: number;
}

/** What a pane shows of its plane [CSS px]. */
export interface PaneView extends Size {
  /** The point in the pane's middle [LPS mm]. */
  center_mm: Vec3;
  pxPerMm: number;
}

/** The scale [CSS px per mm] at which every pane shows its whole plane of the box. */
export function commonScale(bounds_mm: readonly [Vec3, Vec3], panes: Partial<Record<Plane, Size>>): number {
  const side = (axis: Axis) => Math.max(bounds_mm[1][axis] - bounds_mm[0][axis], 1e-6);
  const scales = planeNames.flatMap((plane) => {
    const pane = panes[plane];
    const { across, along } = planes[plane];
    return pane ? [pane.width / side(across), pane.height / side(along)] : [];
  });
  return scales.length ? Math.min(...scales) : 1;
}

const middleOf = (pane: PaneView) => [pane.width / 2, pane.height / 2] as const;

/** The place in a pane of a point, moved into its plane. */
export function canvasOf(layout: PlaneLayout, pane: PaneView, p: Vec3): [number, number] {
  const { across, along, flipped } = layout;
  const { center_mm, pxPerMm } = pane;
  const [x, y] = middleOf(pane);
  return [
    x + (p[across] - center_mm[across]) * pxPerMm,
    y + (p[along] - center_mm[along]) * (flipped ? -pxPerMm : pxPerMm),
  ];
}

/** The point of the plane at `atMm` that is seen at a place of the pane. */
export function pointOf(layout: PlaneLayout, pane: PaneView, atMm: number, x: number, y: number): Vec3 {
  const { across, along, flipped } = layout;
  const [middleX, middleY] = middleOf(pane);
  const p: [number, number, number] = [...pane.center_mm];
  p[layout.normal] = atMm;
  p[across] += (x - middleX) / pane.pxPerMm;
  p[along] += ((y - middleY) / pane.pxPerMm) * (flipped ? -1 : 1);
  return p;
}

/** Where a pane shows the samples of a slice: every one a square. */
export function slicePlace(layout: PlaneLayout, header: SliceHeader, pane: PaneView) {
  const first: [number, number, number] = [0, 0, 0];
  first[layout.across] = header.origin_mm[0] - header.spacing_mm / 2;
  first[layout.along] = header.origin_mm[1] - header.spacing_mm / 2;
  const [left, edge] = canvasOf(layout, pane, first);
  const sample = header.spacing_mm * pane.pxPerMm;
  const height = header.height * sample;
  return { left, top: layout.flipped ? edge - height : edge, width: header.width * sample, height };
}

/** Middle and scale of all panes; zoom 1 shows all of every plane. */
export interface Framing {
  center_mm: Vec3;
  zoom: number;
}

export const mostZoom = 64;

/** Zoomed by `factor` about a point, which stays where it is seen; null: all is seen again. */
export function zoomedFraming(from: Framing, factor: number, about: Vec3): Framing | null {
  const zoom = Math.min(mostZoom, from.zoom * factor);
  if (zoom <= 1) return null;
  return { zoom, center_mm: add(about, scale(sub(from.center_mm, about), from.zoom / zoom)) };
}

/** Moved so that what a pane shows follows a drag of (dx, dy) [CSS px]; the middle stays in the box. */
export function pannedFraming(
  from: Framing,
  layout: PlaneLayout,
  pxPerMm: number,
  [dx, dy]: readonly [number, number],
  [lo, hi]: readonly [Vec3, Vec3],
): Framing {
  const moved: [number, number, number] = [...from.center_mm];
  moved[layout.across] -= dx / pxPerMm;
  moved[layout.along] -= (dy / pxPerMm) * (layout.flipped ? -1 : 1);
  const kept = moved.map((mm, axis) => Math.min(hi[axis]!, Math.max(lo[axis]!, mm)));
  return { ...from, center_mm: kept as unknown as Vec3 };
}
