import type { Histogram } from "../state/volume";
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
  const binOf = (value: number) => ((value - lo) / (hi - lo)) * counts.length;
  for (let i = 0; i < columns; ++i) {
    const from = binOf(span.lo + (i / columns) * (span.hi - span.lo));
    const to = binOf(span.lo + ((i + 1) / columns) * (span.hi - span.lo));
    const first = Math.max(0, Math.floor(from));
    const last = Math.min(counts.length - 1, Math.max(Math.floor(from), Math.ceil(to) - 1));
    let count = 0;
    for (let b = first; b <= last; ++b) count = Math.max(count, counts[b]!);
    out[i] = Math.log1p(count) / most;
  }
  return out;
}
