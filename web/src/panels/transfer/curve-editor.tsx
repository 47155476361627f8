import { useEffect, useId, useRef, useState } from "preact/hooks";
import { toHex } from "../../color";
import { formatNumber, panSpan, ticks, toPixel, toValue, zoomSpan, type Span } from "../../model/axis";
import {
  addPoint,
  clamp,
  colorAt,
  movePoint,
  opacityAt,
  pointOpacity,
  removePoint,
  shiftPoints,
  usesExtinction,
  withOpacity,
} from "../../model/curve";
import { logHeights } from "../../model/histogram";
import { isDiscreteKind, isStepKind, sampleRule } from "../../model/rules";
import { newGesture } from "../../state/scene";
import type { Rule, TransferPoint } from "../../state/scene-types";
import { startDrag } from "../../ui/drag";
import { useItemFocus } from "../../ui/item-focus";
import { useWidth } from "../../ui/use-width";
import type { Domain } from "./domain";

export interface CurveEditorProps {
  label: string;
  points: readonly TransferPoint[];
  kind: Rule["kind"];
  domain: Domain;
  span: Span;
  onSpan(span: Span): void;
  referenceMm: number;
  selected: number;
  onSelect(index: number): void;
  onChange(points: TransferPoint[], gesture: string): void;
  materialColor(name: string): string;
  /** Draws low opacities larger. */
  fine: boolean;
}

const height = 168;
const axisHeight = 30;
const graphHeight = height - axisHeight;
/** So that points at opacities 0 and 1, and at the ends of the values, are whole. */
const margin = 9;

/** Function of one volume: opacity over value, the histogram behind it, the colors below the curve. */
export function CurveEditor(props: CurveEditorProps) {
  const { points, kind, domain, span, referenceMm, selected } = props;
  const root = useRef<SVGSVGElement>(null);
  const frame = useRef<HTMLDivElement>(null);
  const whole = useWidth(frame, 292);
  const width = whole - 2 * margin;
  const gradient = useId();
  const keyGesture = useRef("");
  const [shifting, setShifting] = useState(false);
  const focusPoint = useItemFocus(root, ".dot", points.length);

  const limits: Span = points.reduce(
    (all, p) => ({ lo: Math.min(all.lo, p.value), hi: Math.max(all.hi, p.value) }),
    domain.span,
  );
  const power = props.fine ? 1 / 3 : 1;
  const x = (value: number) => toPixel(span, width, value);
  const y = (opacity: number) => graphHeight - margin - opacity ** power * (graphHeight - 2 * margin);
  const valueAt = (event: MouseEvent) => {
    const value = toValue(span, width, event.clientX - root.current!.getBoundingClientRect().left - margin);
    return isDiscreteKind(kind) ? Math.round(value) : value;
  };
  const opacityAtPixel = (pixel: number) =>
    clamp((graphHeight - margin - pixel) / (graphHeight - 2 * margin), 0, 1) ** (1 / power);
  const rule: Rule = { kind, volume: "", points: [...points], along: "", column_form: "curve", columns: [] };
  const extinction = usesExtinction(points);
  const shownOpacity = (p: TransferPoint) =>
    pointOpacity(p, referenceMm) ??
    (points.some((q) => pointOpacity(q, referenceMm) !== undefined) ? opacityAt(points, p.value, referenceMm) : 0.5);

  const change = (next: TransferPoint[], gesture: string) => props.onChange(next, gesture);

  const place = (index: number, value: number, opacity: number | null, gesture: string) => {
    let next = movePoint(points, index, isDiscreteKind(kind) ? Math.round(value) : value, limits);
    // Single values and steps have no room for two at one value.
    if (kind !== "cctf" && next.some((p, i) => i > 0 && p.value === next[i - 1]!.value)) next = [...points];
    const hasOpacity = points[index]!.opacity !== undefined || points[index]!.mu_t_per_mm !== undefined;
    if (opacity !== null && hasOpacity)
      next[index] = withOpacity(next[index]!, opacity, points[index]!.mu_t_per_mm !== undefined, referenceMm);
    change(next, gesture);
  };

  const dragPoint = (event: PointerEvent, index: number) => {
    if (event.shiftKey) return dragAll(event);
    // Keys mean the point that is chosen, also where it was taken beside its dot.
    (event.currentTarget as Element).parentElement!.querySelector<SVGElement>(".dot")!.focus({ preventScroll: true });
    props.onSelect(index);
    const gesture = newGesture("point");
    const from = points[index]!;
    const fromY = y(shownOpacity(from));
    startDrag(event, {
      move: ({ dx, dy, event: at }) =>
        place(
          index,
          from.value + (dx / width) * (span.hi - span.lo),
          at.ctrlKey || at.metaKey ? null : opacityAtPixel(fromY + dy),
          gesture,
        ),
    });
  };
  const dragAll = (event: PointerEvent) => {
    const gesture = newGesture("shift");
    const from = points;
    setShifting(true);
    startDrag(event, {
      move: ({ dx }) => {
        const by = (dx / width) * (span.hi - span.lo);
        change(shiftPoints(from, isDiscreteKind(kind) ? Math.round(by) : by), gesture);
      },
      end: () => setShifting(false),
    });
  };
  const dragBackground = (event: PointerEvent) => {
    if (event.shiftKey && points.length) return dragAll(event);
    const from = span;
    startDrag(event, {
      move: ({ dx }) => props.onSpan(panSpan(from, limits, (-dx / width) * (from.hi - from.lo))),
    });
  };
  const add = (event: MouseEvent) => {
    const top = root.current!.getBoundingClientRect().top;
    const added = addPoint(points, valueAt(event), opacityAtPixel(event.clientY - top), referenceMm);
    if (kind !== "cctf" && points.some((p) => p.value === added.points[added.selected]!.value)) return;
    focusPoint(added.selected);
    change(added.points, newGesture("add-point"));
    props.onSelect(added.selected);
  };
  const keyDown = (event: KeyboardEvent, index: number) => {
    const sideways = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const upward = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (event.key === "Delete" || event.key === "Backspace") {
      const left = removePoint(points, index);
      focusPoint(left.selected);
      change(left.points, newGesture("delete-point"));
      props.onSelect(left.selected);
    } else if (sideways || upward) {
      if (!event.repeat) keyGesture.current = newGesture("point-key");
      const factor = event.shiftKey ? 10 : 1;
      const step = isDiscreteKind(kind) ? 1 : (span.hi - span.lo) / 300;
      const point = points[index]!;
      place(
        index,
        point.value + (sideways ?? 0) * factor * step,
        upward ? clamp(shownOpacity(point) + upward * factor * (props.fine ? 0.001 : 0.01), 0, 1) : null,
        keyGesture.current,
      );
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  };
  useEffect(() => {
    // Not passive, so that the panel does not scroll.
    const element = root.current!;
    const wheel = (event: WheelEvent) => {
      event.preventDefault();
      const center = toValue(span, width, event.clientX - element.getBoundingClientRect().left - margin);
      if (event.shiftKey || Math.abs(event.deltaX) > Math.abs(event.deltaY))
        props.onSpan(panSpan(span, limits, ((event.deltaX || event.deltaY) / width) * (span.hi - span.lo)));
      else props.onSpan(zoomSpan(span, limits, center, 1.0015 ** event.deltaY));
    };
    element.addEventListener("wheel", wheel, { passive: false });
    return () => element.removeEventListener("wheel", wheel);
  });

  const first = points[0];
  const last = points[points.length - 1];
  return (
    <div ref={frame} class="curve-editor">
      <svg
        ref={root}
        width={whole}
        height={height}
        viewBox={`${-margin} 0 ${whole} ${height}`}
        role="group"
        aria-label={`${props.label}. Double-click to add a point; arrow keys move the chosen point, Delete removes it.`}
        onPointerDown={dragBackground}
        onDblClick={add}
      >
        <defs>
          <linearGradient id={gradient} x1="0" x2="1" y1="0" y2="0">
            {colorStops(rule, span, props.materialColor).map(({ at, color }) => (
              <stop key={at} offset={at} stop-color={color} />
            ))}
          </linearGradient>
        </defs>
        {domain.histogram && <path class="histogram" d={histogramPath(domain, span, width)} />}
        <Grid span={span} width={width} y={y} fine={props.fine} />
        <CurveShape {...{ rule, points, span, width, x, y, referenceMm }} fill={`url(#${gradient})`} />
        {first && last && (
          <rect
            class={shifting ? "shift-handle active" : "shift-handle"}
            x={x(first.value) - 6}
            y={graphHeight}
            width={Math.max(12, x(last.value) - x(first.value) + 12)}
            height={7}
            rx={3}
            fill={`url(#${gradient})`}
            onPointerDown={dragAll}
            onDblClick={(event) => event.stopPropagation()}
          >
            <title>Drag to shift the whole curve (or Shift + drag in the graph)</title>
          </rect>
        )}
        <Axis span={span} width={width} unit={domain.unit} />
        {points.map((p, i) => {
          const opacity = shownOpacity(p);
          const fill = p.color === undefined && p.material ? props.materialColor(p.material) : pointColor(points, p);
          return (
            <g key={i} class={i === selected ? "point selected" : "point"}>
              <circle
                class="hit"
                cx={x(p.value)}
                cy={y(opacity)}
                r={11}
                onPointerDown={(e) => dragPoint(e, i)}
                onDblClick={(e) => e.stopPropagation()}
              />
              <circle
                class="dot"
                cx={x(p.value)}
                cy={y(opacity)}
                r={i === selected ? 6 : 5}
                fill={fill}
                tabindex={0}
                role="button"
                aria-pressed={i === selected}
                aria-label={`Point ${i + 1} of ${points.length}: value ${formatNumber(p.value, (span.hi - span.lo) / 1000)}${domain.unit ? ` ${domain.unit}` : ""}, opacity ${formatNumber(opacity, 0.001)}${extinction ? " (extinction)" : ""}`}
                onFocus={() => props.onSelect(i)}
                onKeyDown={(e) => keyDown(e, i)}
                onPointerDown={(e) => dragPoint(e, i)}
                onDblClick={(e) => e.stopPropagation()}
              />
            </g>
          );
        })}
        {points.length === 0 && (
          <text class="hint" x={width / 2} y={graphHeight / 2} text-anchor="middle">
            Double-click to add a point
          </text>
        )}
      </svg>
    </div>
  );
}

function pointColor(points: readonly TransferPoint[], p: TransferPoint): string {
  const color = colorAt(points, p.value);
  return color ? toHex(p.color ?? { linear: color }) : "#cccccc";
}

function histogramPath(domain: Domain, span: Span, width: number): string {
  const columns = Math.max(1, Math.floor(width / 2));
  const tops = logHeights(domain.histogram!, span, columns).map(
    (h, i) => `L${i * 2} ${(graphHeight - h * (graphHeight - 2 * margin)).toFixed(1)}h2`,
  );
  return `M0 ${graphHeight}${tops.join("")}V${graphHeight}Z`;
}

function colorStops(rule: Rule, span: Span, materialColor: (name: string) => string) {
  const count = 48;
  return Array.from({ length: count + 1 }, (_, i) => {
    const at = i / count;
    const swatch = sampleRule(rule, span.lo + at * (span.hi - span.lo), 0, materialColor);
    return { at, color: swatch ? toHex({ linear: swatch.color }) : "#808080" };
  });
}

/** Round opacities across, for the eye to hold on to. */
function Grid(props: { span: Span; width: number; y(opacity: number): number; fine: boolean }) {
  const levels = props.fine ? [0.01, 0.1, 0.5, 1] : [0.25, 0.5, 0.75, 1];
  return (
    <g class="grid">
      {levels.map((level) => (
        <g key={level}>
          <line x1={0} x2={props.width} y1={props.y(level)} y2={props.y(level)} />
          <text x={-4} y={props.y(level) + (level === 1 ? 9 : -2)}>
            {level}
          </text>
        </g>
      ))}
    </g>
  );
}

function Axis({ span, width, unit }: { span: Span; width: number; unit: string }) {
  const values = ticks(span, 5);
  const resolution = values.length > 1 ? Math.abs(values[1]! - values[0]!) / 2 : (span.hi - span.lo) / 10;
  return (
    <g class="axis">
      {values.map((value) => {
        const at = toPixel(span, width, value);
        if (at < 12 || at > width - 12 - (unit ? 16 : 0)) return null;
        return (
          <text key={value} x={at} y={height - 6} text-anchor="middle">
            {formatNumber(value, resolution)}
          </text>
        );
      })}
      {unit && (
        <text x={width - 2} y={height - 6} text-anchor="end" class="unit">
          {unit}
        </text>
      )}
    </g>
  );
}

/** The curve with its colors below it; steps as steps, single values as stems. */
function CurveShape(props: {
  rule: Rule;
  points: readonly TransferPoint[];
  span: Span;
  width: number;
  x(value: number): number;
  y(opacity: number): number;
  referenceMm: number;
  fill: string;
}) {
  const { rule, points, span, width, x, y, referenceMm } = props;
  if (points.length === 0) return null;
  const opacity = (p: TransferPoint) => pointOpacity(p, referenceMm) ?? 0.5;
  if (isDiscreteKind(rule.kind))
    return (
      <g class="stems">
        {points.map((p, i) => (
          <line key={i} x1={x(p.value)} x2={x(p.value)} y1={y(0)} y2={y(opacity(p))} />
        ))}
      </g>
    );
  let line: string;
  if (isStepKind(rule.kind)) {
    line = `M${x(points[0]!.value)} ${y(0)}${points.map((p) => `H${x(p.value)}V${y(opacity(p))}`).join("")}H${Math.max(width, x(points[points.length - 1]!.value))}`;
  } else {
    const columns = Math.ceil(width / 2);
    const places = Array.from({ length: columns + 1 }, (_, i) => span.lo + (i / columns) * (span.hi - span.lo));
    const seen = points.map((p) => p.value).filter((v) => v > span.lo && v < span.hi);
    const epsilon = (span.hi - span.lo) * 1e-6;
    const dense = points.some((p) => pointOpacity(p, referenceMm) !== undefined);
    const all = [...places, ...seen.flatMap((v) => [v - epsilon, v])].sort((a, b) => a - b);
    line =
      "M" +
      all.map((v) => `${x(v).toFixed(1)} ${y(dense ? opacityAt(points, v, referenceMm) : 0.5).toFixed(1)}`).join("L");
  }
  const start = isStepKind(rule.kind) ? x(points[0]!.value) : 0;
  return (
    <g class="curve">
      <path class="area" d={`${line}V${y(0)}H${start}Z`} fill={props.fill} />
      <path class="line" d={line} />
    </g>
  );
}
