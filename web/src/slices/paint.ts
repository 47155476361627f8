import { decode, greyTable, type Window } from "../model/window";
import type { LabelColor } from "../state/label-colors";
import type { Slice } from "./fetch-slice";

/** Grey picture of a slice, a pixel a sample. */
export function paintGrey(slice: Slice, window: Window): ImageData {
  const { header, samples } = slice;
  const table = greyTable(header, window);
  const image = new ImageData(header.width, header.height);
  const pixels = new Uint32Array(image.data.buffer);
  for (let i = 0; i < samples.length; ++i) {
    const u = samples[i]!;
    const grey = table[u]!;
    // Outside the volume nothing is drawn.
    pixels[i] = u === 0 ? 0 : 0xff000000 | (grey << 16) | (grey << 8) | grey;
  }
  return image;
}

/** Labels of a slice in their colors; 0 and what is hidden are clear. */
export function paintLabels(slice: Slice, colors: ReadonlyMap<number, LabelColor>): ImageData {
  const { header, samples } = slice;
  const byCode = new Map<number, number>();
  const image = new ImageData(header.width, header.height);
  const pixels = new Uint32Array(image.data.buffer);
  for (let i = 0; i < samples.length; ++i) {
    const u = samples[i]!;
    let color = byCode.get(u);
    if (color === undefined) {
      const label = Math.round(decode(header, u) ?? 0);
      const seen = colors.get(label);
      color = label === 0 || !seen || seen.hidden ? 0 : abgr(seen.color);
      byCode.set(u, color);
    }
    pixels[i] = color;
  }
  return image;
}

/** "#rrggbb" as a pixel of ImageData on little-endian machines. */
function abgr(hex: string): number {
  const rgb = Number.parseInt(hex.slice(1), 16);
  return (0xff000000 | ((rgb & 255) << 16) | (rgb & 0xff00) | (rgb >> 16)) >>> 0;
}
