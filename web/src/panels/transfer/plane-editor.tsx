import { useEffect, useRef } from "preact/hooks";
import { toHex } from "../../color";
import { formatNumber, ticks, toPixel, toValue, type Span } from "../../model/axis";
import { clamp } from "../../model/curve";
import { jointHeights } from "../../model/histogram";
import { addColumn, moveColumn, sampleRule } from "../../model/rules";
import { newGesture } from "../../state/scene";
import type { Rule, RuleColumn } from "../../state/scene-types";
import type { JointHistogram } from "../../state/volume";
import { startDrag } from "../../ui/drag";
import { useItemFocus } from "../../ui/item-focus";
import { useWidth } from "../../ui/use-width";
import { useJointHistogram, type Domain } from "./domain";

const height = 150;
/** CSS px a sample of the map, and one of the histogram behind it. */
const cell = 4;
const countCell = 2;
/** As the curve editor's below it. */
const margin = 9;
/** Above and below the outermost values [px]. */
const frameBorder = 8;

/** A 2-D rule as a map over the joint histogram of its volumes: the first one's value to the right, the second's
 * upward; its columns are the lines. */
export function PlaneEditor(props: {
  rule: Rule;
  span: Span;
  along: Domain;
  selected: number;
  onSelect(column: number): void;
  onChange(columns: RuleColumn[], gesture: string): void;
  materialColor(name: string): string;
}) {
  const { rule, span, along, selected } = props;
  const frame = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const counts = useRef<HTMLCanvasElement>(null);
  const histogram = useJointHistogram(rule.volume, rule.along);
  const width = useWidth(frame, 292);
  const keyGesture = useRef("");
  const { columns } = rule;
  const focusColumn = useItemFocus(frame, ".column .hit", columns.length);
  const discrete = rule.column_form === "points";
  const limits: Span = columns.reduce(
    (all, column) => ({ lo: Math.min(all.lo, column.at), hi: Math.max(all.hi, column.at) }),
    along.span,
  );
  const y = (at: number) => height - frameBorder - toPixel(limits, height - 2 * frameBorder, at);
  const atPixel = (pixel: number) => {
    const at = clamp(toValue(limits, height - 2 * frameBorder, height - frameBorder - pixel), limits.lo, limits.hi);
    return discrete ? Math.round(at) : at;
  };
  const gap = discrete ? 1 : (limits.hi - limits.lo) / 2000;

  useEffect(
    () => drawMap(canvas.current!, rule, span, (row) => atPixel(row), props.materialColor),
    [rule, span, limits.lo, limits.hi, width],
  );

  useEffect(
    () => drawCounts(counts.current!, histogram, span, limits),
    [histogram, span.lo, span.hi, limits.lo, limits.hi, width],
  );

  const add = (event: MouseEvent) => {
    const pixel = event.clientY - frame.current!.getBoundingClientRect().top;
    const added = addColumn(columns, atPixel(pixel));
    focusColumn(added.selected);
    props.onChange(added.columns, newGesture("add-column"));
    props.onSelect(added.selected);
  };
  const drag = (event: PointerEvent, index: number) => {
    props.onSelect(index);
    const gesture = newGesture("column");
    const from = y(columns[index]!.at);
    startDrag(event, {
      move: ({ dy }) => props.onChange(moveColumn(columns, index, atPixel(from + dy), gap), gesture),
    });
  };
  const keyDown = (event: KeyboardEvent, index: number) => {
    const upward = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (event.key === "Delete" && columns.length > 1) {
      focusColumn(Math.max(0, index - 1));
      props.onChange(
        columns.filter((_, i) => i !== index),
        newGesture("delete-column"),
      );
      props.onSelect(Math.max(0, index - 1));
    } else if (upward) {
      if (!event.repeat) keyGesture.current = newGesture("column-key");
      const step = (discrete ? 1 : (limits.hi - limits.lo) / 100) * (event.shiftKey ? 10 : 1);
      props.onChange(moveColumn(columns, index, columns[index]!.at + upward * step, gap), keyGesture.current);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  };

  const levels = ticks(limits, 4);
  const resolution = levels.length > 1 ? (levels[1]! - levels[0]!) / 2 : 1;
  return (
    <div ref={frame} class="plane-editor">
      <canvas
        ref={counts}
        class="counts"
        role="img"
        aria-label={histogram ? "Joint histogram of the two volumes" : "No joint histogram"}
        width={Math.ceil(width / countCell)}
        height={height / countCell}
        style={{ width, height }}
      />
      <canvas
        ref={canvas}
        width={Math.ceil(width / cell)}
        height={Math.ceil(height / cell)}
        style={{ width, height }}
      />
      <svg
        width={width}
        height={height}
        role="group"
        aria-label="Columns of the rule. Double-click to add one."
        onDblClick={add}
      >
        {levels.map((level) => (
          <text key={level} x={3} y={y(level) + 3}>
            {formatNumber(level, resolution)}
          </text>
        ))}
        {columns.map((column, i) => (
          <g key={i} class={i === selected ? "column selected" : "column"}>
            <line x1={0} x2={width} y1={y(column.at)} y2={y(column.at)} />
            <line
              class="hit"
              x1={0}
              x2={width}
              y1={y(column.at)}
              y2={y(column.at)}
              tabindex={0}
              role="button"
              aria-pressed={i === selected}
              aria-label={`Column at ${formatNumber(column.at, resolution / 10)}`}
              onFocus={() => props.onSelect(i)}
              onPointerDown={(event) => drag(event, i)}
              onDblClick={(event) => event.stopPropagation()}
              onKeyDown={(event) => keyDown(event, i)}
            />
            {column.points.map((p, k) => (
              <circle key={k} cx={margin + toPixel(span, width - 2 * margin, p.value)} cy={y(column.at)} r={2.5} />
            ))}
          </g>
        ))}
      </svg>
    </div>
  );
}

function drawMap(
  canvas: HTMLCanvasElement,
  rule: Rule,
  span: Span,
  alongAt: (pixel: number) => number,
  materialColor: (name: string) => string,
): void {
  const context = canvas.getContext("2d")!;
  const { width, height: rows } = canvas;
  context.clearRect(0, 0, width, rows);
  for (let row = 0; row < rows; ++row) {
    const along = alongAt((row + 0.5) * cell);
    for (let column = 0; column < width; ++column) {
      const swatch = sampleRule(
        rule,
        toValue(span, width * cell - 2 * margin, (column + 0.5) * cell - margin),
        along,
        materialColor,
      );
      if (!swatch || swatch.opacity <= 0) continue;
      context.globalAlpha = 0.15 + 0.85 * swatch.opacity ** 0.5;
      context.fillStyle = toHex({ linear: swatch.color });
      context.fillRect(column, row, 1, 1);
    }
  }
}

/** Where there are voxels, the more the denser. */
function drawCounts(canvas: HTMLCanvasElement, histogram: JointHistogram | null, span: Span, limits: Span): void {
  const context = canvas.getContext("2d")!;
  const { width, height: rows } = canvas;
  context.clearRect(0, 0, width, rows);
  if (!histogram) return;
  const shown = (of: Span, pixels: number, border: number): Span => ({
    lo: toValue(of, pixels - 2 * border, -border),
    hi: toValue(of, pixels - 2 * border, pixels - border),
  });
  const heights = jointHeights(
    histogram,
    shown(span, width * countCell, margin),
    shown(limits, height, frameBorder),
    width,
    rows,
  );
  context.fillStyle = getComputedStyle(canvas).color;
  heights.forEach((share, i) => {
    if (!(share > 0)) return;
    context.globalAlpha = 0.12 + 0.88 * share;
    context.fillRect(i % width, Math.floor(i / width), 1, 1);
  });
}
