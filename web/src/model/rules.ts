import type { Rule, RuleColumn, TransferPoint, Vec3 } from "../state/scene-types";
import { clamp, colorAt, numberKeys, opacityAt } from "./curve";
import { mix } from "../geometry/vec3";
import type { Span } from "./axis";

export const ruleKinds: readonly { kind: Rule["kind"]; name: string; summary: string }[] = [
  { kind: "cctf", name: "Curve", summary: "Coefficients are linear between points" },
  { kind: "cpctf", name: "Steps", summary: "A point holds up to the next one" },
  { kind: "cdptf", name: "Single values", summary: "A point holds at its value alone (labels)" },
  { kind: "mpctf", name: "Material steps", summary: "Steps that name materials" },
  { kind: "mdptf", name: "Materials by value", summary: "A label and its material" },
];

export const mostRules = 16;
export const mostProxies = 3;

export function isMaterialKind(kind: Rule["kind"]): boolean {
  return kind === "mpctf" || kind === "mdptf";
}
export function isDiscreteKind(kind: Rule["kind"]): boolean {
  return kind === "cdptf" || kind === "mdptf";
}
export function isStepKind(kind: Rule["kind"]): boolean {
  return kind === "cpctf" || kind === "mpctf";
}

/** A rule to begin with: what is drawn of it can be seen and moved. `span` is that of the volume's values. */
export function newRule(kind: Rule["kind"], volume: string, span: Span): Rule {
  return { kind, volume, along: "", column_form: "curve", columns: [], points: newPoints(kind, span) };
}

function newPoints(kind: Rule["kind"], span: Span): TransferPoint[] {
  const at = (share: number) => span.lo + share * (span.hi - span.lo);
  if (isDiscreteKind(kind)) {
    const value = Math.round(clamp(Math.max(1, span.lo), span.lo, span.hi));
    return [kind === "mdptf" ? { value, material: "lesion" } : { value, color: "#f07a1c" }];
  }
  if (kind === "mpctf") return [{ value: at(0.6), material: "lesion", opacity: 0.9 }];
  if (kind === "cpctf") return [{ value: at(0.6), opacity: 0.9, color: "#f07a1c" }];
  return [
    { value: at(0.5), opacity: 0, color: "#f07a1c" },
    { value: at(0.7), opacity: 0.6, color: "#f07a1c" },
  ];
}

/** The rule with another kind: what its points may not give any more is dropped, what they must is added. */
export function withKind(rule: Rule, kind: Rule["kind"]): Rule {
  const convert = (points: TransferPoint[]): TransferPoint[] => {
    const values = new Set<number>();
    const out: TransferPoint[] = [];
    for (const point of points) {
      const { material, ...rest } = point;
      const value = isDiscreteKind(kind) ? Math.round(point.value) : point.value;
      if (kind !== "cctf" && values.has(value)) continue;
      values.add(value);
      out.push(isMaterialKind(kind) ? { ...rest, value, material: material ?? "lesion" } : { ...rest, value });
    }
    return out;
  };
  return {
    ...rule,
    kind,
    points: convert(rule.points),
    columns: rule.columns.map((column) => ({ ...column, points: convert(column.points) })),
  };
}

/** The rule with a second volume, its function the same at every value of that; or without ("" ). */
export function withAlong(rule: Rule, along: string, span: Span, discrete: boolean): Rule {
  if (!along) return { ...rule, along: "", columns: [], points: rule.columns[0]?.points ?? rule.points };
  const points = rule.columns[0]?.points ?? rule.points;
  const at = (share: number) => span.lo + share * (span.hi - span.lo);
  const columns: RuleColumn[] = discrete
    ? [{ at: Math.round(Math.max(1, span.lo)), points }]
    : [
        { at: at(0.1), points: points.map(transparent) },
        { at: at(0.5), points },
      ];
  return { ...rule, along, points: [], column_form: discrete ? "points" : "curve", columns };
}

function transparent(point: TransferPoint): TransferPoint {
  if (point.mu_t_per_mm !== undefined) return { ...point, mu_t_per_mm: 0 };
  return point.opacity !== undefined ? { ...point, opacity: 0 } : point;
}

/** Adds a column at a value of the second volume, with the points of the nearest one. */
export function addColumn(columns: readonly RuleColumn[], at: number): { columns: RuleColumn[]; selected: number } {
  const nearest = columns.reduce<RuleColumn | undefined>(
    (best, one) => (!best || Math.abs(one.at - at) < Math.abs(best.at - at) ? one : best),
    undefined,
  );
  if (nearest?.at === at) return { columns: [...columns], selected: columns.indexOf(nearest) };
  const beyond = columns.findIndex((column) => column.at > at);
  const selected = beyond < 0 ? columns.length : beyond;
  const added = { at, points: nearest?.points ?? [] };
  return { columns: [...columns.slice(0, selected), added, ...columns.slice(selected)], selected };
}

/** Moves a column between its neighbours, `gap` away from them: no two may be alike. */
export function moveColumn(columns: readonly RuleColumn[], index: number, at: number, gap: number): RuleColumn[] {
  const lo = index > 0 ? columns[index - 1]!.at + gap : -Infinity;
  const hi = index + 1 < columns.length ? columns[index + 1]!.at - gap : Infinity;
  return columns.map((column, i) =>
    i === index ? { ...column, at: lo > hi ? column.at : clamp(at, lo, hi) } : column,
  );
}

export function moved<T>(list: readonly T[], from: number, to: number): T[] {
  const out = [...list];
  const [item] = out.splice(from, 1);
  if (item !== undefined) out.splice(clamp(to, 0, out.length), 0, item);
  return out;
}

/** What matter looks like at a place of a rule's domain. */
export interface Swatch {
  opacity: number;
  /** Linear. */
  color: Vec3;
}

/** The points that hold at `value`, as a function that can be interpolated: steps and single values become constants. */
function sampleColumn(
  kind: Rule["kind"],
  points: readonly TransferPoint[],
  value: number,
  materialColor: (name: string) => string,
): Swatch | null {
  const colored = points.map((p) =>
    p.color === undefined && p.material ? { ...p, color: materialColor(p.material) } : p,
  );
  let used: TransferPoint[] = colored;
  if (isDiscreteKind(kind)) used = colored.filter((p) => Math.abs(p.value - value) <= 0.5).slice(0, 1);
  else if (isStepKind(kind)) used = colored.filter((p) => p.value <= value).slice(-1);
  if (used.length === 0) return null;
  const tints = !used.some((p) => numberKeys.slice(0, 2).some((key) => p[key] !== undefined));
  return { opacity: tints ? 0.5 : opacityAt(used, value, 1), color: colorAt(used, value) ?? [0.8, 0.8, 0.8] };
}

/** What a rule makes of a value, at a value of its second volume; null where it does not apply. */
export function sampleRule(
  rule: Rule,
  value: number,
  along: number,
  materialColor: (name: string) => string,
): Swatch | null {
  if (!rule.along) return sampleColumn(rule.kind, rule.points, value, materialColor);
  const { columns } = rule;
  const beyond = columns.findIndex((column) => column.at > along);
  const upper = beyond < 0 ? columns.length : beyond;
  const sample = (i: number) => sampleColumn(rule.kind, columns[i]!.points, value, materialColor);
  if (rule.column_form === "points") {
    const i = columns.findIndex((column) => Math.abs(column.at - along) <= 0.5);
    return i < 0 ? null : sample(i);
  }
  if (rule.column_form === "steps") return upper > 0 ? sample(upper - 1) : null;
  if (columns.length === 0) return null;
  if (upper === 0) return sample(0);
  if (upper === columns.length) return sample(upper - 1);
  const a = sample(upper - 1);
  const b = sample(upper);
  const lower = columns[upper - 1]!.at;
  const share = (along - lower) / (columns[upper]!.at - lower);
  if (!a || !b) return share < 0.5 ? a : b;
  return { opacity: a.opacity + (b.opacity - a.opacity) * share, color: mix(a.color, b.color, share) };
}
