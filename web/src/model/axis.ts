/** A stretch of data values [lo, hi], lo < hi, as an editor shows it. */
export interface Span {
  lo: number;
  hi: number;
}

/** Place of `value` along `length` pixels that show `span`. */
export function toPixel(span: Span, length: number, value: number): number {
  return ((value - span.lo) / (span.hi - span.lo)) * length;
}

export function toValue(span: Span, length: number, pixel: number): number {
  return span.lo + (pixel / length) * (span.hi - span.lo);
}

/** `span` enlarged (factor > 1) or shrunk about `center`, never beyond `limits` nor below a thousandth of them. */
export function zoomSpan(span: Span, limits: Span, center: number, factor: number): Span {
  const whole = limits.hi - limits.lo;
  const width = Math.min(whole, Math.max(whole / 1000, (span.hi - span.lo) * factor));
  const share = (center - span.lo) / (span.hi - span.lo);
  return panSpan({ lo: center - share * width, hi: center + (1 - share) * width }, limits, 0);
}

/** `span` moved by `by` data units, kept within `limits`. */
export function panSpan(span: Span, limits: Span, by: number): Span {
  const width = Math.min(span.hi - span.lo, limits.hi - limits.lo);
  const lo = Math.min(Math.max(span.lo + by, limits.lo), limits.hi - width);
  return { lo, hi: lo + width };
}

/** The smallest of 1, 2, 5 times a power of ten that is at least `step`. */
export function niceStep(step: number): number {
  const power = 10 ** Math.floor(Math.log10(step));
  const digit = step / power;
  return (digit <= 1 ? 1 : digit <= 2 ? 2 : digit <= 5 ? 5 : 10) * power;
}

/** Round values within `span`, at most about `count` of them. */
export function ticks(span: Span, count: number): number[] {
  const step = niceStep((span.hi - span.lo) / Math.max(1, count));
  const out: number[] = [];
  for (let n = Math.ceil(span.lo / step); n * step <= span.hi; ++n) out.push(n * step + 0);
  return out;
}

/** A number as short as `resolution` (the least difference that matters) allows. */
export function formatNumber(value: number, resolution: number): string {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e7 || size < 1e-5) return value.toExponential(2);
  const digits = Math.max(0, Math.min(8, Math.ceil(-Math.log10(Math.max(resolution, 1e-12)))));
  const text = value.toFixed(digits);
  return digits > 0 ? text.replace(/\.?0+$/, "") : text;
}

/** A data value with its unit, to a thousandth of the data's range, or to 0.1 HU. */
export function formatValue(value: number, facts: { hounsfield: boolean; range: readonly [number, number] }): string {
  const resolution = facts.hounsfield ? 0.1 : (facts.range[1] - facts.range[0]) / 1000;
  const text = formatNumber(Math.abs(value) < resolution / 2 ? 0 : value, resolution);
  return facts.hounsfield ? `${text} HU` : text;
}
