import { mix } from "../geometry/vec3";
import { linear } from "../color";
import type { Color, Rule, RuleColumn, Transfer, TransferPoint } from "../state/scene-types";
import { extinctionOfOpacity, sampleAt } from "./curve";
import { hiddenBelow } from "./label-rules";
import { isDiscreteKind, isStepKind } from "./rules";

/** How labels are seen in the scene, by the rules that speak of them. */

export interface LabelPaint {
  hidden: boolean;
  /** Absent: no rule gives one. */
  color?: Color;
}

/** Values of other volumes at the place that is painted; undefined outside of them. */
export type Elsewhere = (volume: string) => number | undefined;

type Sample = (value: number) => TransferPoint | undefined;

/** What points say of a value: those by value are looked up in a table. */
function sampleOf(kind: Rule["kind"], points: readonly TransferPoint[]): Sample {
  if (isDiscreteKind(kind)) {
    const byValue = new Map([...points].reverse().map((point) => [Math.round(point.value), point]));
    return (value) => byValue.get(Math.round(value));
  }
  if (isStepKind(kind)) return (value) => points.filter((point) => point.value <= value).at(-1);
  return (value) => (points.length ? sampleAt(points, value) : undefined);
}

const givesExtinction = (point: TransferPoint) => point.opacity !== undefined || point.mu_t_per_mm !== undefined;

/** Of a reference length of 1 mm: between columns it counts which of them have matter. */
const extinctionOf = (point: TransferPoint): number | undefined =>
  point.mu_t_per_mm ?? (point.opacity === undefined ? undefined : extinctionOfOpacity(point.opacity, 1));

/** Between two columns, as the renderer has it: what one alone gives is its own, and one without matter has no color. */
function betweenColumns(
  a: TransferPoint | undefined,
  b: TransferPoint | undefined,
  share: number,
): TransferPoint | undefined {
  if (!a && !b) return undefined;
  const value = (a ?? b)!.value;
  const [first, second] = [a ?? { value }, b ?? { value }];
  const out: TransferPoint = share < 0.5 ? { ...second, ...first } : { ...first, ...second };
  const [dense, denser] = [extinctionOf(first), extinctionOf(second)];
  if (dense !== undefined || denser !== undefined) {
    delete out.opacity;
    out.mu_t_per_mm = (dense ?? 0) * (1 - share) + (denser ?? 0) * share;
  }
  if (first.color === undefined || second.color === undefined) return out;
  if (dense === 0 || denser === 0) out.color = dense === 0 ? second.color : first.color;
  else out.color = { linear: mix(linear(first.color), linear(second.color), share) };
  return out;
}

/** What the columns of a rule say of the two values. */
function sampleOfColumns(rule: Rule, columns: readonly RuleColumn[]): (value: number, along: number) => TransferPoint | undefined {
  const samples = columns.map((column) => sampleOf(rule.kind, column.points));
  return (value, along) => {
    const found = columns.findIndex((column) => column.at > along);
    const beyond = found < 0 ? columns.length : found;
    if (rule.column_form === "points") return columns[beyond - 1]?.at === along ? samples[beyond - 1]!(value) : undefined;
    if (rule.column_form === "steps") return samples[beyond - 1]?.(value);
    if (beyond === 0 || beyond === columns.length) return samples[Math.max(0, beyond - 1)]?.(value);
    const lower = columns[beyond - 1]!.at;
    const share = (along - lower) / (columns[beyond]!.at - lower);
    return betweenColumns(samples[beyond - 1]!(value), samples[beyond]!(value), share);
  };
}

/** What a rule says where its volumes have values. */
function ruleAt(rule: Rule, materialColor: (name: string) => Color | undefined): (valueOf: Elsewhere) => TransferPoint | undefined {
  const colored = (points: readonly TransferPoint[]) =>
    points.map((point) => (point.color === undefined && point.material ? withColor(point, materialColor(point.material)) : point));
  if (!rule.along) {
    const at = sampleOf(rule.kind, colored(rule.points));
    return (valueOf) => {
      const value = valueOf(rule.volume);
      return value === undefined ? undefined : at(value);
    };
  }
  const at = sampleOfColumns(rule, rule.columns.map((column) => ({ ...column, points: colored(column.points) })));
  return (valueOf) => {
    const [value, along] = [valueOf(rule.volume), valueOf(rule.along)];
    return value === undefined || along === undefined ? undefined : at(value, along);
  };
}

const withColor = (point: TransferPoint, color: Color | undefined): TransferPoint =>
  color === undefined ? point : { ...point, color };

const speaksOf = (rule: Rule, volume: string) => rule.volume === volume || rule.along === volume;
const pointsOf = (rule: Rule) => (rule.along ? rule.columns.flatMap((column) => column.points) : rule.points);

/** The other volumes whose values decide how labels of `volume` are seen. */
export function volumesBeside(rules: readonly Rule[], volume: string): string[] {
  const read = rules.filter((rule) => rule.along && speaksOf(rule, volume)).flatMap((rule) => [rule.volume, rule.along]);
  return [...new Set(read)].filter((name) => name !== volume);
}

/** How rules have a label of `volume` at a place: the color is that of the first rule that gives one, itself or by its
 * material. */
export function labelPainter(
  { rules, merge }: Pick<Transfer, "rules" | "merge">,
  volume: string,
  materialColor: (name: string) => Color | undefined,
): (label: number, elsewhere: Elsewhere) => LabelPaint {
  const used = rules
    .filter((rule) => speaksOf(rule, volume))
    .map((rule) => ({ at: ruleAt(rule, materialColor), dense: pointsOf(rule).some(givesExtinction) }));
  return (label, elsewhere) => {
    const valueOf: Elsewhere = (name) => (name === volume ? label : elsewhere(name));
    const paint: LabelPaint = { hidden: false };
    let decided = false;
    for (const { at, dense } of used) {
      const point = at(valueOf);
      if (!point) {
        // A product has nothing where one of its factors has nothing.
        if (dense && merge === "product") paint.hidden = true;
        continue;
      }
      const extinction = point.mu_t_per_mm ?? point.opacity;
      // By priority and as the greatest, a rule without opacity does not apply.
      if (extinction === 0 && merge !== "product") continue;
      const clear = extinction === 0 || (point.mu_t_per_mm !== undefined && point.mu_t_per_mm <= hiddenBelow);
      if (clear && (merge === "product" || (merge === "priority" && !decided))) paint.hidden = true;
      if (extinction !== undefined) decided = true;
      paint.color ??= point.color;
    }
    return paint;
  };
}

/** How labels of `volume` are seen wherever they are: by rules of one dimension. */
export function paintsOf(
  { rules, merge }: Pick<Transfer, "rules" | "merge">,
  volume: string,
  values: Iterable<number>,
  materialColor: (name: string) => Color | undefined,
): Map<number, LabelPaint> {
  const paint = labelPainter({ rules: rules.filter((rule) => !rule.along), merge }, volume, materialColor);
  return new Map([...values].map((value) => [value, paint(value, () => undefined)]));
}
