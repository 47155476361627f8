import { moved, mostRules, newRule, ruleKinds, withAlong, withKind } from "../../model/rules";
import { edit, newGesture, scene } from "../../state/scene";
import type { Rule, Scene, Transfer } from "../../state/scene-types";
import { Button, IconButton, Select } from "../../ui/controls";
import { ruleVolumes, spanOf, type Domain } from "./domain";

const kindName = (kind: Rule["kind"]) => ruleKinds.find((one) => one.kind === kind)!.name;

function describe(rule: Rule): string {
  const count = rule.along ? `${rule.columns.length} columns` : `${rule.points.length} points`;
  return `${kindName(rule.kind)}, ${count}`;
}

const merges: { value: Transfer["merge"]; label: string; hint: string }[] = [
  {
    value: "priority",
    label: "First that applies",
    hint: "Every coefficient is that of the first rule that applies and gives it",
  },
  {
    value: "product",
    label: "Product",
    hint: "Opacities and colors are multiplied: matter is seen only where every rule has it",
  },
  { value: "maximum", label: "Densest", hint: "The rule of the greatest extinction comes first" },
];

/** The functions of the scene in their order: rules, then the curve of the data. `chosen` -1 is the curve. */
export function RuleList({ of, chosen, onChoose }: { of: Scene; chosen: number; onChoose(rule: number): void }) {
  const { rules, merge } = of.transfer;
  const set = (next: Rule[]) => edit([["/transfer/rules", next]], newGesture("rules"));
  const volumes = ruleVolumes(of);
  const add = async () => {
    const labels = volumes.find((volume) => volume.discrete);
    const name = labels?.name ?? volumes.find((v) => v.name !== "data" && v.name !== "opacity")?.name ?? "data";
    const span = await spanOf(name);
    // Meanwhile others may have changed the rules.
    edit([
      ["/transfer/rules", [newRule(labels ? "mdptf" : "cctf", name, span), ...(scene.peek()?.transfer.rules ?? [])]],
    ]);
    onChoose(0);
  };
  return (
    <>
      <ol class="rule-list">
        {rules.map((rule, i) => (
          <li key={i} class={i === chosen ? "chosen" : ""}>
            <button type="button" class="name" aria-pressed={i === chosen} onClick={() => onChoose(i)}>
              <span>{rule.along ? `${rule.volume} × ${rule.along}` : rule.volume}</span>
              <small>{describe(rule)}</small>
            </button>
            <IconButton
              icon="chevron"
              class="up"
              label="Earlier"
              disabled={i === 0}
              onClick={() => (set(moved(rules, i, i - 1)), chosen === i && onChoose(i - 1))}
            />
            <IconButton
              icon="chevron"
              class="down"
              label="Later"
              disabled={i === rules.length - 1}
              onClick={() => (set(moved(rules, i, i + 1)), chosen === i && onChoose(i + 1))}
            />
            <IconButton
              icon="delete"
              label="Remove the rule"
              onClick={() => (set(rules.filter((_, k) => k !== i)), onChoose(-1))}
            />
          </li>
        ))}
        <li class={chosen < 0 ? "chosen" : ""}>
          <button type="button" class="name" aria-pressed={chosen < 0} onClick={() => onChoose(-1)}>
            <span>Curve of the data</span>
            <small>{rules.length ? "last, for what no rule decides" : `${of.transfer.points.length} points`}</small>
          </button>
        </li>
      </ol>
      {rules.length > 0 && (
        <Select
          label="Merge"
          value={merge}
          options={merges}
          hint={merges.find((m) => m.value === merge)?.hint}
          onChange={(value) => edit([["/transfer/merge", value]])}
        />
      )}
      <div class="row-actions">
        <Button icon="add" onClick={() => void add()} disabled={rules.length >= mostRules}>
          Add a rule
        </Button>
      </div>
    </>
  );
}

/** What a rule is a function of. */
export function RuleFields(props: {
  of: Scene;
  rule: Rule;
  domain: Domain;
  along: Domain;
  onChange(rule: Rule, gesture: string): void;
}) {
  const { rule } = props;
  const volumes = ruleVolumes(props.of).map(({ name, title }) => ({ value: name, label: title }));
  const change = (next: Rule) => props.onChange(next, newGesture("rule"));
  const discrete = (name: string) => ruleVolumes(props.of).find((v) => v.name === name)?.discrete ?? false;
  const ownLabels = discrete(rule.volume);
  return (
    <>
      <Select
        label="Kind"
        value={rule.kind}
        options={ruleKinds
          .filter(({ kind }) => ownLabels || (kind !== "cdptf" && kind !== "mdptf"))
          .map(({ kind, name, summary }) => ({ value: kind, label: name, hint: summary }))}
        onChange={(kind) => change(withKind(rule, kind))}
      />
      <Select
        label="Of"
        value={rule.volume}
        options={volumes}
        onChange={(name) => {
          const kind =
            !discrete(name) && rule.kind === "cdptf"
              ? "cpctf"
              : !discrete(name) && rule.kind === "mdptf"
                ? "mpctf"
                : rule.kind;
          change({ ...withKind(rule, kind), volume: name });
        }}
      />
      <Select
        label="Along"
        value={rule.along}
        hint="A second volume: the rule is then a function of two values"
        options={[{ value: "", label: "Nothing (1-D)" }, ...volumes.filter((v) => v.value !== rule.volume)]}
        onChange={(name) => change(withAlong(rule, name, props.along.span, discrete(name)))}
      />
      {rule.along && (
        <Select
          label="Between columns"
          value={rule.column_form}
          options={[
            { value: "curve", label: "Interpolated" },
            { value: "steps", label: "Hold to the next" },
            ...(discrete(rule.along) ? [{ value: "points" as const, label: "At their value alone" }] : []),
          ]}
          onChange={(column_form) => change({ ...rule, column_form })}
        />
      )}
    </>
  );
}
