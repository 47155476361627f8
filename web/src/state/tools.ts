import { signal } from "@preact/signals";

/** What is drawn over the picture and what pointing at it does. Panels may switch these, too. */

/** Navigate: drags move the camera. Measure: clicks set the ends of distances. */
export type PointerTool = "navigate" | "measure";
export const pointerTool = signal<PointerTool>("navigate");

/** Handles of the lights, of the clip box. */
export const lightHandles = signal(false);
export const clipHandles = signal(false);
/** Index into scene.lights of the light that handles and panel show as chosen. */
export const selectedLight = signal<number | null>(null);
