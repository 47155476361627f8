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

/** What of a volume's facts a window is made of. */
export interface ValueFacts {
  range: readonly [number, number];
  percentiles: Record<string, number>;
  histogram: { lo: number; hi: number; counts: readonly number[] };
}

/** White lies above the foreground by this share, so that the brightest tissue is told from white. */
const kHeadroom = 0.1;
const kWhitePercent = 98;
/** With fewer bins between the 0.1 and 99.9 percentiles, outliers have taken the histogram. */
const kLeastBins = 16;

/** The window for values without a known unit. Background, most of an MR or microscopy volume, does not count for
 * white: the histogram is divided into background and foreground where both differ most (Otsu 1979), and white is
 * 10 % above the foreground's 98th percentile. Black is the 1st percentile of all values. */
export function automaticWindow({ range, percentiles, histogram }: ValueFacts): Window {
  const black = percentiles["1"] ?? range[0];
  const bright = foregroundPercentile(histogram, percentiles) ?? percentiles["99"] ?? range[1];
  const white = Math.min(range[1], bright + kHeadroom * (bright - black));
  return white > black
    ? { level: (black + white) / 2, width: white - black }
    : { level: (range[0] + range[1]) / 2, width: Math.max(range[1] - range[0], 1e-6) };
}

/** Null where the histogram does not tell. */
function foregroundPercentile(
  { lo, hi, counts }: ValueFacts["histogram"],
  { "0.1": low = lo, "99.9": high = hi }: Record<string, number>,
): number | null {
  const bin = (hi - lo) / counts.length;
  if (!(high - low >= kLeastBins * bin) || bin <= 0) return null;
  const first = foregroundStart(counts);
  const total = counts.slice(first).reduce((sum, n) => sum + n, 0);
  let left = (total * kWhitePercent) / 100;
  for (let i = first; i < counts.length; ++i) {
    if (left <= counts[i]!) return lo + (i + left / counts[i]!) * bin;
    left -= counts[i]!;
  }
  return null;
}

/** The first bin of the upper one of two classes whose means differ most, by the classes' sizes. */
function foregroundStart(counts: readonly number[]): number {
  const all = counts.reduce((sum, n) => sum + n, 0);
  const moment = counts.reduce((sum, n, i) => sum + n * i, 0);
  let [best, start, below, belowMoment] = [0, 0, 0, 0];
  for (let i = 0; i + 1 < counts.length; ++i) {
    below += counts[i]!;
    belowMoment += counts[i]! * i;
    if (below === 0 || below === all) continue;
    const apart = belowMoment / below - (moment - belowMoment) / (all - below);
    const between = below * (all - below) * apart * apart;
    if (between > best) [best, start] = [between, i + 1];
  }
  return start;
}

/** Digits after the point that tell a thousandth of a window, at least one. */
export function windowDigits({ width }: Window): number {
  return Math.min(20, Math.max(1, Math.ceil(-Math.log10(width / 1000))));
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
