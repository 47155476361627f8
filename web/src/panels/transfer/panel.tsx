import { useState } from "preact/hooks";
import { toHex } from "../../color";
import type { Span } from "../../model/axis";
import { addPoint, pointOpacity, removePoint, replacePoint } from "../../model/curve";
import { materialColor } from "../../state/label-colors";
import { edit, newGesture, scene } from "../../state/scene";
import type { Rule, Scene, TransferPoint } from "../../state/scene-types";
import { IconButton, Section } from "../../ui/controls";
import { Disclosure } from "../../ui/disclosure";
import { CurveEditor } from "./curve-editor";
import { useDomain } from "./domain";
import { PlaneEditor } from "./plane-editor";
import { PointFields } from "./point-fields";
import { Presets } from "./presets";
import { Proxies } from "./proxies";
import { RuleFields, RuleList } from "./rule-list";
import { numberFields } from "../number-fields";

/** Name, range, unit and step of what all points share. */
const TransferNumber = numberFields("/transfer", {
  density_scale: { label: "Density", hint: "Multiplies the extinction of all matter", min: 0.01, max: 100, hardMin: 0, hardMax: 1e6, logarithmic: true, digits: 3, initial: 1 },
  reference_length_mm: { label: "Thickness of the opacities", hint: "A layer this thick has the opacity of the curve", unit: "mm", min: 0.01, max: 20, hardMin: 1e-6, hardMax: 1e6, logarithmic: true, digits: 3 },
});

/** Colors of materials for what is drawn of rules. */
function drawnColor(name: string): string {
  const color = materialColor(name);
  return color ? toHex(color) : "#cccccc";
}

/** The function that is edited: points of the scene's own curve, of a rule, or of a rule's column. */
interface Chosen {
  rule: Rule | null;
  points: readonly TransferPoint[];
  /** Where the points are in the scene. */
  pointer: string;
}

function chosenFunction(of: Scene, index: number, column: number): Chosen {
  const rule = of.transfer.rules[index];
  if (!rule) return { rule: null, points: of.transfer.points, pointer: "/transfer/points" };
  const pointer = `/transfer/rules/${index}`;
  if (!rule.along) return { rule, points: rule.points, pointer: `${pointer}/points` };
  const k = Math.min(column, rule.columns.length - 1);
  return { rule, points: rule.columns[k]?.points ?? [], pointer: `${pointer}/columns/${k}/points` };
}

export function TransferPanel() {
  const of = scene.value;
  const [index, setIndex] = useState(-1);
  if (!of) return null;
  const known = of.transfer.rules[index] ? index : -1;
  return (
    <>
      <Section title="Presets">
        <Presets />
      </Section>
      <FunctionEditor key={known} of={of} index={known} />
      <Section title="Rules" closed={of.transfer.rules.length === 0}>
        <RuleList of={of} chosen={known} onChoose={setIndex} />
      </Section>
      <Section title="Further volumes" closed={of.proxies.length === 0}>
        <Proxies of={of} />
      </Section>
    </>
  );
}

function FunctionEditor({ of, index }: { of: Scene; index: number }) {
  // Until one is chosen the last: the first often is where nothing is.
  const [chosenColumn, setColumn] = useState<number | null>(null);
  const column = chosenColumn ?? (of.transfer.rules[index]?.columns.length ?? 1) - 1;
  const [selected, setSelected] = useState(0);
  const [zoomed, setZoomed] = useState<Span | null>(null);
  const [fine, setFine] = useState<boolean | null>(null);
  const { rule, points, pointer } = chosenFunction(of, index, column);
  const domain = useDomain(rule?.volume ?? "data");
  const along = useDomain(rule?.along || "data");
  const kind = rule?.kind ?? "cctf";
  const span = zoomed ?? domain.span;
  const referenceMm = of.transfer.reference_length_mm ?? 1;
  const densest = points.reduce((most, p) => Math.max(most, pointOpacity(p, referenceMm) ?? 0), 0);
  const thin = densest > 0 && densest < 0.1;
  const isFine = fine ?? thin;
  const chosen = Math.min(selected, points.length - 1);
  const change = (next: TransferPoint[], gesture: string) => {
    // A curve that was changed is no preset's any more; without points it is the preset's again.
    const leaves = !rule && next.length > 0 && Boolean(of.transfer.preset);
    edit(leaves ? [[pointer, next], ["/transfer/preset", null]] : [[pointer, next]], gesture);
  };
  const addInMiddle = () => {
    const added = addPoint(points, (span.lo + span.hi) / 2, 0.5, referenceMm);
    change(added.points, newGesture("add-point"));
    setSelected(added.selected);
  };
  const remove = () => {
    const left = removePoint(points, chosen);
    change(left.points, newGesture("delete-point"));
    setSelected(left.selected);
  };
  const actions = (
    <>
      <IconButton icon="enlarge" label="Show low opacities larger" pressed={isFine} onClick={() => setFine(!isFine)} />
      <IconButton icon="fit" label="Show all values" disabled={!zoomed} onClick={() => setZoomed(null)} />
      <IconButton icon="add" label="Add a point" onClick={addInMiddle} />
      <IconButton
        icon="delete"
        label="Delete the chosen point"
        disabled={chosen < 0 || (rule !== null && points.length === 1)}
        onClick={remove}
      />
    </>
  );
  return (
    <Section title={rule ? `Rule ${index + 1}` : "Opacity and color"} actions={actions}>
      {rule && (
        <RuleFields
          of={of}
          rule={rule}
          domain={domain}
          along={along}
          onChange={(next, gesture) => edit([[`/transfer/rules/${index}`, next]], gesture)}
        />
      )}
      {rule?.along && (
        <PlaneEditor
          rule={rule}
          span={span}
          along={along}
          selected={Math.min(column, rule.columns.length - 1)}
          onSelect={setColumn}
          onChange={(columns, gesture) => edit([[`/transfer/rules/${index}/columns`, columns]], gesture)}
          materialColor={drawnColor}
        />
      )}
      <CurveEditor
        label={rule ? `Function of ${rule.volume}` : "Opacity over the data's values"}
        points={points}
        kind={kind}
        domain={domain}
        span={span}
        onSpan={setZoomed}
        referenceMm={referenceMm}
        selected={chosen}
        onSelect={setSelected}
        onChange={change}
        materialColor={drawnColor}
        fine={isFine}
      />
      <PointFields
        points={points}
        index={chosen}
        kind={kind}
        domain={domain}
        referenceMm={referenceMm}
        onChange={(point, gesture) => change(replacePoint(points, chosen, point), gesture)}
      />
      {!rule && <Density of={of} />}
    </Section>
  );
}

function Density({ of }: { of: Scene }) {
  const { density_scale, reference_length_mm } = of.transfer;
  return (
    <>
      <TransferNumber name="density_scale" value={density_scale} />
      <Disclosure label="What opacities refer to">
        <TransferNumber name="reference_length_mm" value={reference_length_mm ?? 1} />
      </Disclosure>
    </>
  );
}
