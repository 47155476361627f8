import { computed, signal, type ReadonlySignal } from "@preact/signals";
import type { ComponentType } from "preact";
import { pointAtDepth, project, ray, type PicturePoint, type Ray } from "../geometry/projection";
import type { Vec3 } from "../geometry/vec3";
import { frame } from "../state/frame";
import type { FrameCamera } from "../state/protocol";

/** What is drawn over the picture: SVG in CSS pixels of the view area, whose top left corner is (0, 0). */

/** The view area's size [CSS px]; set by the view. */
export const viewSize = signal({ width: 1, height: 1 });

export interface ViewProjection {
  camera: FrameCamera;
  /** Where the picture is in the view area [CSS px]. */
  rect: { x: number; y: number; width: number; height: number };
  /** A point of the scene in the view area [CSS px]; depth_mm <= 0 is behind a perspective eye. */
  project(p_mm: Vec3): PicturePoint;
  /** The line of sight through a place of the view area. */
  ray(x: number, y: number): Ray;
  /** The point at a place of the view area, in the plane that faces the camera at `depth_mm`. */
  pointAtDepth(x: number, y: number, depth_mm: number): Vec3;
  /** CSS px that 1 mm covers in the plane at `depth_mm`. */
  pxPerMm(depth_mm: number): number;
}

/** Where a picture of `full` size lies in a view: as large as fits, in its middle. */
export function letterbox(full: readonly [number, number], view: { width: number; height: number }) {
  const scale = Math.min(view.width / full[0], view.height / full[1]);
  const width = full[0] * scale;
  const height = full[1] * scale;
  return { x: (view.width - width) / 2, y: (view.height - height) / 2, width, height };
}

/** How the picture on screen is seen; null while there is none. Changes with every frame of another camera. */
export const view: ReadonlySignal<ViewProjection | null> = computed(() => {
  const header = frame.value?.header;
  if (!header) return null;
  const { camera } = header;
  const rect = letterbox(header.full, viewSize.value);
  const across = (x: number) => (x - rect.x) / rect.width;
  const down = (y: number) => (y - rect.y) / rect.height;
  return {
    camera,
    rect,
    project: (p) => {
      const seen = project(camera, p);
      return { x: rect.x + seen.x * rect.width, y: rect.y + seen.y * rect.height, depth_mm: seen.depth_mm };
    },
    ray: (x, y) => ray(camera, across(x), down(y)),
    pointAtDepth: (x, y, depth_mm) => pointAtDepth(camera, across(x), down(y), depth_mm),
    pxPerMm: (depth_mm) => rect.height / (2 * camera.half_height * (camera.orthographic ? 1 : depth_mm)),
  };
});

/** Further overlays, each an SVG group (<g>), drawn in order over the picture. Panels add theirs here. Elements that
 * take the pointer have the class "handle". */
export const overlays = signal<readonly { id: string; component: ComponentType }[]>([]);

export function addOverlay(id: string, component: ComponentType): void {
  overlays.value = [...overlays.value.filter((other) => other.id !== id), { id, component }];
}
