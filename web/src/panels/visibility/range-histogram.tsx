import { useRef } from "preact/hooks";
import { formatNumber, toPixel, toValue } from "../../model/axis";
import { clamp } from "../../model/curve";
import { logHeights } from "../../model/histogram";
import { newGesture } from "../../state/scene";
import type { Range } from "../../state/scene-types";
import { startDrag } from "../../ui/drag";
import { useWidth } from "../../ui/use-width";
import type { Domain } from "../transfer/domain";

const height = 56;
const margin = 6;

/** A range of values on the histogram: two ends to drag, and the range itself. */
export function RangeHistogram(props: {
  label: string;
  domain: Domain;
  range: Range;
  onChange(range: Range, gesture: string): void;
}) {
  const { domain, range } = props;
  const { span } = domain;
  const frame = useRef<HTMLDivElement>(null);
  const whole = useWidth(frame, 270);
  const width = whole - 2 * margin;
  const keyGesture = useRef("");
  const x = (value: number) => margin + toPixel(span, width, clamp(value, span.lo, span.hi));
  const set = (end: 0 | 1, value: number, gesture: string) => {
    const other = range[1 - end]!;
    props.onChange(end === 0 ? [Math.min(value, other), other] : [other, Math.max(value, other)], gesture);
  };
  const drag = (event: PointerEvent, end: 0 | 1) => {
    const gesture = newGesture("range");
    const from = x(range[end]!);
    startDrag(event, {
      move: ({ dx }) => set(end, clamp(toValue(span, width, from + dx - margin), span.lo, span.hi), gesture),
    });
  };
  const dragBoth = (event: PointerEvent) => {
    const gesture = newGesture("range");
    const [lo, hi] = range.map((v) => clamp(v, span.lo, span.hi)) as [number, number];
    startDrag(event, {
      move: ({ dx }) => {
        const by = clamp((dx / width) * (span.hi - span.lo), span.lo - lo, span.hi - hi);
        props.onChange([lo + by, hi + by], gesture);
      },
    });
  };
  const keyDown = (event: KeyboardEvent, end: 0 | 1) => {
    const sideways = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (!sideways) return;
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat) keyGesture.current = newGesture("range-key");
    const step = ((span.hi - span.lo) / 300) * (event.shiftKey ? 10 : 1);
    set(end, clamp(range[end]! + sideways * step, span.lo, span.hi), keyGesture.current);
  };
  const columns = Math.max(1, Math.floor(width / 2));
  const bars = domain.histogram
    ? logHeights(domain.histogram, span, columns)
        .map((h, i) => `M${margin + 2 * i} ${height}v${(-h * (height - 8)).toFixed(1)}h2V${height}`)
        .join("")
    : "";
  return (
    <div ref={frame} class="range-histogram">
      <svg width={whole} height={height} role="group" aria-label={props.label}>
        <path class="histogram" d={bars} />
        <rect
          class="range"
          x={x(range[0])}
          y={0}
          width={Math.max(1, x(range[1]) - x(range[0]))}
          height={height}
          onPointerDown={dragBoth}
        />
        {([0, 1] as const).map((end) => (
          <g key={end} class="range-end">
            <line x1={x(range[end]!)} x2={x(range[end]!)} y1={0} y2={height} />
            <rect
              x={x(range[end]!) - 6}
              y={0}
              width={12}
              height={height}
              tabindex={0}
              role="slider"
              aria-label={end === 0 ? "From" : "To"}
              aria-valuemin={span.lo}
              aria-valuemax={span.hi}
              aria-valuenow={range[end]!}
              aria-valuetext={`${formatNumber(range[end]!, (span.hi - span.lo) / 1000)} ${domain.unit}`}
              onPointerDown={(event) => drag(event, end)}
              onKeyDown={(event) => keyDown(event, end)}
            />
          </g>
        ))}
      </svg>
    </div>
  );
}
