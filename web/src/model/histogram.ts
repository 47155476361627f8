import type { Histogram, JointHistogram } from "../state/volume";
import type { Span } from "./axis";

/** The value at the middle of a bin. */
export function binValue(histogram: Histogram, bin: number): number {
  return histogram.lo + ((bin + 0.5) / histogram.counts.length) * (histogram.hi - histogram.lo);
}

/**
 * Heights in [0, 1] of `columns` columns that show `span`: log(1 + n) of the greatest count that a column meets, relative to the
 * histogram's greatest, so that heights stay when the axis is zoomed.
 */
export function logHeights(histogram: Histogram, span: Span, columns: number): number[] {
  const { lo, hi, counts } = histogram;
  const most = Math.log1p(counts.reduce((a, b) => Math.max(a, b), 0));
  const out = new Array<number>(columns).fill(0);
  if (!(most > 0) || !(hi > lo)) return out;
  binsMet(histogram, counts.length, span, columns).forEach(([first, last], i) => {
    let count = 0;
    for (let b = first; b <= last; ++b) count = Math.max(count, counts[b]!);
    out[i] = Math.log1p(count) / most;
  });
  return out;
}

/** Heights as logHeights() has them, of a `columns` x `rows` map of the plane: x to the right, y upward, the top row first. */
export function jointHeights(histogram: JointHistogram, x: Span, y: Span, columns: number, rows: number): number[] {
  const { counts } = histogram;
  const most = Math.log1p(counts.reduce((a, b) => Math.max(a, b), 0));
  const out = new Array<number>(columns * rows).fill(0);
  if (!(most > 0)) return out;
  const across = binsMet(histogram.x, histogram.columns, x, columns);
  const up = binsMet(histogram.y, histogram.rows, y, rows);
  for (let row = 0; row < rows; ++row) {
    const [low, high] = up[rows - 1 - row]!;
    for (let column = 0; column < columns; ++column) {
      const [first, last] = across[column]!;
      let count = 0;
      for (let b = low; b <= high; ++b)
        for (let a = first; a <= last; ++a) count = Math.max(count, counts[b * histogram.columns + a]!);
      out[row * columns + column] = Math.log1p(count) / most;
    }
  }
  return out;
}

/** The first and last of `bins` bins over `whole` that each of `cells` equal parts of `span` meets; none: last < first. */
function binsMet(whole: Span, bins: number, span: Span, cells: number): [number, number][] {
  const binOf = (value: number) => ((value - whole.lo) / (whole.hi - whole.lo)) * bins;
  return Array.from({ length: cells }, (_, i) => {
    const from = binOf(span.lo + (i / cells) * (span.hi - span.lo));
    const to = binOf(span.lo + ((i + 1) / cells) * (span.hi - span.lo));
    const last = Math.max(Math.floor(from), Math.ceil(to) - 1);
    return [Math.max(0, Math.floor(from)), Math.min(bins - 1, last)];
  });
}
