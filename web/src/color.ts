import type { Color, Vec3 } from "./state/scene-types";

/** Colors of the scene and of the screen. */

const toSrgb = (x: number) => (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
const toLinear = (x: number) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
const clamp01 = (x: number) => Math.min(1, Math.max(0, x));

/** sRGB channels 0 to 1 of "#rrggbb". */
function channels(hex: string): Vec3 {
  const n = Number.parseInt(hex.slice(1), 16);
  return [((n >> 16) & 255) / 255, ((n >> 8) & 255) / 255, (n & 255) / 255];
}

function hexOf(srgb: Vec3): string {
  return `#${srgb
    .map((c) =>
      Math.round(clamp01(c) * 255)
        .toString(16)
        .padStart(2, "0"),
    )
    .join("")}`;
}

/** "#rrggbb" of any color of a scene; linear channels above 1 are cut off. */
export function toHex(color: Color): string {
  if (typeof color === "string") return color;
  if ("linear" in color) return hexOf(color.linear.map(toSrgb) as unknown as Vec3);
  return hexOf(color);
}

/** Linear Rec. 709 of any color of a scene. */
export function linear(color: Color): Vec3 {
  if (typeof color === "string") return channels(color).map(toLinear) as unknown as Vec3;
  if ("linear" in color) return color.linear;
  return color.map(toLinear) as unknown as Vec3;
}

/** A color whose channels may exceed 1 as one that can be shown, and the factor that was taken out. */
export function splitScale(color: Color): { hex: string; scale: number } {
  const channels = linear(color);
  const scale = Math.max(...channels);
  if (!(scale > 1)) return { hex: toHex(color), scale: 1 };
  return { hex: toHex({ linear: channels.map((c) => c / scale) as unknown as Vec3 }), scale };
}

/** Inverse of splitScale. */
export function joinScale(hex: string, scale: number): Color {
  return scale === 1 ? hex : { linear: linear(hex).map((c) => c * scale) as unknown as Vec3 };
}
