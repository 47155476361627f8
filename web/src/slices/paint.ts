import type { SliceHeader } from "../model/slice";
import { decode, greyTable, type Window } from "../model/window";
import type { LabelPainting } from "../state/label-colors";
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

/** A slice's samples on the grid of another one of its plane: the nearest, 0 outside. */
function onGrid(grid: SliceHeader, { header, samples }: Slice): Uint16Array {
  if (grid === header) return samples;
  const nearest = (axis: 0 | 1, count: number, most: number) =>
    Array.from({ length: count }, (_, i) => {
      const mm = grid.origin_mm[axis] + i * grid.spacing_mm;
      const at = Math.round((mm - header.origin_mm[axis]) / header.spacing_mm);
      return at >= 0 && at < most ? at : -1;
    });
  const columns = nearest(0, grid.width, header.width);
  const rows = nearest(1, grid.height, header.height);
  const out = new Uint16Array(grid.width * grid.height);
  rows.forEach((row, j) => {
    if (row < 0) return;
    columns.forEach((column, i) => {
      if (column >= 0) out[j * grid.width + i] = samples[row * header.width + column]!;
    });
  });
  return out;
}

/** Labels of a slice in their colors, with the grid that they are painted on: the finest of those that decide. `beside`
 * has the slices of the volumes that the painting reads. 0 and what is hidden are clear. */
export function paintLabels(
  slice: Slice,
  painting: LabelPainting,
  beside: ReadonlyMap<string, Slice>,
): { image: ImageData; header: SliceHeader } {
  const names = painting.beside.filter((name) => beside.has(name));
  const others = names.map((name) => beside.get(name)!);
  const { header } = others.reduce((a, b) => (b.header.spacing_mm < a.header.spacing_mm ? b : a), slice);
  const samples = onGrid(header, slice);
  const codes = others.map((other) => onGrid(header, other));
  const colorAt = (i: number): number => {
    const label = Math.round(decode(slice.header, samples[i]!) ?? 0);
    const seen = painting.at(label, (name) => {
      const n = names.indexOf(name);
      return n < 0 ? undefined : decode(others[n]!.header, codes[n]![i]!);
    });
    return label === 0 || !seen || seen.hidden ? 0 : abgr(seen.color);
  };
  const known = new Map<number | string, number>();
  const image = new ImageData(header.width, header.height);
  const pixels = new Uint32Array(image.data.buffer);
  for (let i = 0; i < samples.length; ++i) {
    if (samples[i] === 0) continue;
    let key: number | string = samples[i]!;
    for (const code of codes) key = `${key} ${code[i]}`;
    let color = known.get(key);
    if (color === undefined) known.set(key, (color = colorAt(i)));
    pixels[i] = color;
  }
  return { image, header };
}

/** "#rrggbb" as a pixel of ImageData on little-endian machines. */
function abgr(hex: string): number {
  const rgb = Number.parseInt(hex.slice(1), 16);
  return (0xff000000 | ((rgb & 255) << 16) | (rgb & 0xff00) | (rgb >> 16)) >>> 0;
}
