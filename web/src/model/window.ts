/** Data values from level - width / 2 (black) to level + width / 2 (white). width > 0. */
export interface Window {
  level: number;
  width: number;
}

/** Usual windows of CT [HU]. */
export const ctWindows: readonly { name: string; window: Window }[] = [
  { name: "Soft tissue", window: { level: 40, width: 400 } },
  { name: "Bone", window: { level: 500, width: 2000 } },
  { name: "Brain", window: { level: 40, width: 80 } },
  { name: "Lung", window: { level: -600, width: 1500 } },
];

/** The window that shows all between the 1st and the 99th percentile. */
export function percentileWindow(percentiles: Record<string, number>, range: readonly [number, number]): Window {
  const lo = percentiles["1"] ?? range[0];
  const hi = percentiles["99"] ?? range[1];
  return hi > lo
    ? { level: (lo + hi) / 2, width: hi - lo }
    : { level: (range[0] + range[1]) / 2, width: Math.max(range[1] - range[0], 1e-6) };
}

/** A drag of `dx`, `dy` pixels (y downward): to the right widens, upward brightens; `extent` is that of the data's values. */
export function dragWindow(from: Window, dx: number, dy: number, extent: number): Window {
  const perPixel = Math.max(from.width, extent / 200) / 250;
  return { level: from.level + dy * perPixel, width: Math.max(extent / 1e5, from.width + dx * perPixel) };
}

/** Samples of a slice: value = offset + scale * (u - 1), and 0 for none. */
export interface SliceCode {
  scale: number;
  offset: number;
}

export function decode(code: SliceCode, u: number): number | undefined {
  return u === 0 ? undefined : code.offset + code.scale * (u - 1);
}

/** Grey 0 to 255 for each of the 65536 codes; 0 where there is no value. */
export function greyTable(code: SliceCode, window: Window): Uint8ClampedArray {
  const table = new Uint8ClampedArray(65536);
  const lowest = window.level - window.width / 2;
  const perCode = (255 * code.scale) / window.width;
  const first = (255 * (code.offset - lowest)) / window.width;
  for (let u = 1; u < 65536; ++u) table[u] = first + perCode * (u - 1);
  return table;
}
