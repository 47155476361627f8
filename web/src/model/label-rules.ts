import type { Color, Rule, TransferPoint } from "../state/scene-types";

/**
 * How a label looks. All absent: as the function's own points have it.
 *
 * Material and color alone keep the opacity of the function's points; with an opacity the label is as opaque as that, whatever
 * the data.
 */
export interface LabelLook {
  hidden?: boolean;
  material?: string;
  color?: Color;
  opacity?: number;
}

/**
 * Extinction of hidden labels [1/mm].
 *
 * By priority a rule with no extinction does not apply, and the next one, at last the function's own points, decides. One that is
 * above 0 applies: matter of 1e-9 / mm hides all rules after it and is itself never seen.
 */
export const hiddenExtinction = 1e-9;
/** What is no more than this is hidden. */
export const hiddenBelow = 1e-7;

/** Whether the rule gives looks to single labels of `volume`. */
function isLabelRule(rule: Rule, volume: string): boolean {
  return rule.volume === volume && !rule.along && (rule.kind === "cdptf" || rule.kind === "mdptf");
}

/** Whether the points of a rule say no more than a LabelLook does. */
function isPlain(point: TransferPoint): boolean {
  return (
    Object.keys(point).every((key) => ["value", "opacity", "mu_t_per_mm", "color", "material"].includes(key)) &&
    (point.mu_t_per_mm === undefined || point.mu_t_per_mm <= hiddenBelow)
  );
}

function isOwned(rule: Rule, volume: string): boolean {
  return isLabelRule(rule, volume) && (rule.points ?? []).every(isPlain);
}

/** The looks that rules with single points give to labels of `volume`. */
export function readLooks(rules: readonly Rule[], volume: string): Map<number, LabelLook> {
  const looks = new Map<number, LabelLook>();
  for (const rule of rules) {
    if (!isOwned(rule, volume)) continue;
    for (const p of rule.points ?? []) {
      const look = looks.get(p.value) ?? {};
      if (look.hidden) continue;
      if (p.mu_t_per_mm !== undefined) look.hidden = true;
      if (look.material === undefined && p.material) look.material = p.material;
      if (look.color === undefined && p.color !== undefined) look.color = p.color;
      if (look.opacity === undefined && p.opacity !== undefined) look.opacity = p.opacity;
      looks.set(p.value, look);
    }
  }
  return looks;
}

function isPlainLook(look: LabelLook): boolean {
  return !look.hidden && look.material === undefined && look.color === undefined && look.opacity === undefined;
}

/** Rules for the looks: of a rule's points either all give an extinction or none, so hidden, dense and tinted labels take one each. */
function rulesOfLooks(looks: ReadonlyMap<number, LabelLook>, volume: string): Rule[] {
  const hidden: TransferPoint[] = [];
  const dense: TransferPoint[] = [];
  const denseMaterial: TransferPoint[] = [];
  const tint: TransferPoint[] = [];
  const tintMaterial: TransferPoint[] = [];
  for (const [value, look] of [...looks].sort((a, b) => a[0] - b[0])) {
    if (look.hidden) {
      hidden.push({ value, mu_t_per_mm: hiddenExtinction });
      continue;
    }
    if (isPlainLook(look)) continue;
    const point: TransferPoint = { value };
    if (look.opacity !== undefined) point.opacity = look.opacity;
    if (look.color !== undefined) point.color = look.color;
    if (look.material !== undefined) point.material = look.material;
    const isDense = look.opacity !== undefined;
    if (look.material !== undefined) (isDense ? denseMaterial : tintMaterial).push(point);
    else (isDense ? dense : tint).push(point);
  }
  const rules: Rule[] = [];
  const add = (kind: Rule["kind"], points: TransferPoint[]) => {
    if (points.length) rules.push({ kind, volume, points, along: "", column_form: "curve", columns: [] });
  };
  add("cdptf", hidden);
  add("mdptf", denseMaterial);
  add("cdptf", dense);
  add("mdptf", tintMaterial);
  add("cdptf", tint);
  return rules;
}

/**
 * `rules` with those of `volume`'s labels replaced by what `looks` need, where the first of them stood, or before all others.
 * What a hidden label was before is not kept.
 */
export function writeLooks(rules: readonly Rule[], volume: string, looks: ReadonlyMap<number, LabelLook>): Rule[] {
  const first = rules.findIndex((rule) => isOwned(rule, volume));
  const before = rules.slice(0, Math.max(0, first)).filter((rule) => !isOwned(rule, volume));
  const after = rules.slice(Math.max(0, first)).filter((rule) => !isOwned(rule, volume));
  return [...before, ...rulesOfLooks(looks, volume), ...after];
}

/** `looks` with that of one label changed; one that says nothing is dropped. */
export function withLook(
  looks: ReadonlyMap<number, LabelLook>,
  label: number,
  change: Partial<LabelLook>,
): Map<number, LabelLook> {
  const look = { ...looks.get(label), ...change };
  for (const key of Object.keys(look) as (keyof LabelLook)[])
    if (look[key] === undefined || look[key] === false) delete look[key];
  const out = new Map(looks);
  if (isPlainLook(look)) out.delete(label);
  else out.set(label, look);
  return out;
}

/** Whether other rules speak of the labels, too, so that the list shows only a part. */
export function hasOtherRules(rules: readonly Rule[], volume: string): boolean {
  return rules.some((rule) => (rule.volume === volume || rule.along === volume) && !isOwned(rule, volume));
}

/** What no label marks, in lists of labels. */
export const unlabelled = { value: 0, name: "", color: "#808080" } as const;

/** A label's name as pages write it. */
export function titleOf(label: { value: number; name: string }): string {
  return label.name.replaceAll("_", " ") || (label.value === 0 ? "Unlabelled" : `Label ${label.value}`);
}
