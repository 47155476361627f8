import { useState } from "preact/hooks";
import {
  hasOtherRules,
  readLooks,
  titleOf,
  unlabelled,
  withLook,
  writeLooks,
  type LabelLook,
} from "../../model/label-rules";
import { isSought } from "../../model/label-search";
import { mostProxies } from "../../model/rules";
import { labelColors } from "../../state/label-colors";
import { edit, newGesture, scene } from "../../state/scene";
import type { Scene } from "../../state/scene-types";
import { labels, type LabelName } from "../../state/volume";
import { Button, ColorField, IconButton, Section, Select, Slider, Toggle } from "../../ui/controls";
import { FilePicker } from "../file-picker";
import { Icon } from "../../ui/icons";
import { materialNames } from "../transfer/point-fields";
import { addProxy, fileProxy, freeName, nameOfPath } from "../transfer/proxies";

/** More rows make the list slow; a search finds the others. */
const mostRows = 300;

/** Colors of /labels as rules that can be changed label by label: the picture stays as it is. */
function editSingleLabels(of: Scene): void {
  const name = freeName(of, nameOfPath(of.labels!.path));
  const looks = new Map<number, LabelLook>();
  for (const { value, color } of labels.peek()["labels"] ?? []) if (value !== 0) looks.set(value, { color });
  const proxy = { ...fileProxy(name), path: of.labels!.path, lookup: "nearest" };
  edit([
    ["/proxies/-", proxy],
    ["/transfer/rules", writeLooks(of.transfer.rules, name, looks)],
    ["/labels", null],
  ]);
}

export function LabelsPanel() {
  const of = scene.value;
  const [chosen, setChosen] = useState<string | null>(null);
  const [picking, setPicking] = useState(false);
  if (!of) return null;
  const volumes = of.proxies.filter((proxy) => proxy.lookup === "nearest");
  const name = volumes.find((proxy) => proxy.name === chosen)?.name ?? volumes[0]?.name;
  return (
    <>
      <div class="panel-top">
        {volumes.length > 1 && (
          <Select
            label="Labels of"
            value={name!}
            options={volumes.map((v) => ({ value: v.name, label: v.name }))}
            onChange={setChosen}
          />
        )}
        {volumes.length === 0 && (
          <p class="note">A label volume names the parts of the picture: an atlas, or a segmentation of this volume.</p>
        )}
        <div class="row-actions">
          <Button icon="add" disabled={of.proxies.length >= mostProxies} onClick={() => setPicking(true)}>
            Label volume from a file
          </Button>
          {of.labels && volumes.length === 0 && (
            <Button
              icon="labels"
              title="Colors by label become rules, one label at a time"
              onClick={() => editSingleLabels(of)}
            >
              Edit single labels
            </Button>
          )}
        </div>
      </div>
      {name && <LabelList key={name} of={of} name={name} />}
      {of.labels && (
        <Section title="Colors of all labels">
          <Slider
            label="Strength"
            hint="How much of a label's color replaces the curve's"
            min={0}
            max={1}
            step={0.01}
            value={of.labels.strength}
            onChange={(value, gesture) => edit([["/labels/strength", value]], gesture)}
          />
        </Section>
      )}
      {picking && (
        <FilePicker
          title="Add a label volume"
          onClose={() => setPicking(false)}
          onPick={(path) => {
            setPicking(false);
            setChosen(addProxy(of, { name: nameOfPath(path), path, lookup: "nearest" }));
          }}
        />
      )}
    </>
  );
}

function LabelList({ of, name }: { of: Scene; name: string }) {
  const [search, setSearch] = useState("");
  const [open, setOpen] = useState<number | null>(null);
  const { rules, merge } = of.transfer;
  const looks = readLooks(rules, name);
  const listed = labels.value[name] ?? [];
  // What no label marks is a part like any other: hiding it leaves the labels.
  const all = listed.some((label) => label.value === 0)
    ? listed
    : [unlabelled, ...listed];
  const found = all.filter((label) => isSought(label.value, titleOf(label), search));
  const colors = labelColors.value[name];
  const write = (next: ReadonlyMap<number, LabelLook>, gesture = newGesture("labels")) =>
    edit([["/transfer/rules", writeLooks(rules, name, next)]], gesture);
  const change = (values: readonly number[], by: (label: LabelName) => Partial<LabelLook>, gesture?: string) => {
    const wanted = new Set(values);
    write(
      all
        .filter((label) => wanted.has(label.value))
        .reduce((map, label) => withLook(map, label.value, by(label)), looks as Map<number, LabelLook>),
      gesture,
    );
  };
  const values = found.map((label) => label.value);
  const visible = found.filter((label) => !looks.get(label.value)?.hidden).length;
  return (
    <Section title={`${name}: ${listed.length} labels`}>
      {merge !== "priority" && rules.length > 0 && (
        <p class="note warning">
          Rules are merged as {merge === "product" ? "a product" : "the densest"}; labels are hidden and made opaque by
          priority only.{" "}
          <button type="button" class="link" onClick={() => edit([["/transfer/merge", "priority"]])}>
            Merge by priority
          </button>
        </p>
      )}
      {hasOtherRules(rules, name) && (
        <p class="note">Other rules use {name}, too: the transfer function panel has them.</p>
      )}
      <input
        class="text"
        type="search"
        placeholder="Search"
        aria-label={`Search labels of ${name}`}
        value={search}
        onInput={(event) => setSearch(event.currentTarget.value)}
        onKeyDown={(event) => event.stopPropagation()}
      />
      <div class="row-actions compact">
        <Button onClick={() => change(values, () => ({ hidden: false }))} title="Shows all that are listed">
          Show
        </Button>
        <Button onClick={() => change(values, () => ({ hidden: true }))} title="Hides all that are listed">
          Hide
        </Button>
        <Button
          title="Hides all but those listed"
          disabled={found.length === all.length}
          onClick={() =>
            write(
              all.reduce(
                (map, label) => withLook(map, label.value, { hidden: !values.includes(label.value) }),
                looks as Map<number, LabelLook>,
              ),
            )
          }
        >
          Only these
        </Button>
        <Button
          title="Gives all that are listed the file's colors"
          onClick={() =>
            change(
              values.filter((v) => v !== 0),
              (label) => ({ color: label.color }),
            )
          }
        >
          Color
        </Button>
        <Button
          title="Takes hiding, materials and colors from all that are listed"
          onClick={() =>
            change(values, () => ({ hidden: undefined, material: undefined, color: undefined, opacity: undefined }))
          }
        >
          Reset
        </Button>
      </div>
      <p class="note" aria-live="polite">
        {search ? `${found.length} found, ` : ""}
        {visible} of {found.length} visible
      </p>
      <ul class="label-list">
        {found.slice(0, mostRows).map((label) => (
          <LabelRow
            key={label.value}
            label={label}
            look={looks.get(label.value) ?? {}}
            color={colors?.get(label.value)?.color ?? label.color}
            open={open === label.value}
            onOpen={() => setOpen(open === label.value ? null : label.value)}
            onChange={(by, gesture) => change([label.value], () => by, gesture)}
          />
        ))}
      </ul>
      {found.length > mostRows && <p class="note">{found.length - mostRows} more: search to see them.</p>}
    </Section>
  );
}

const asItIs = "";

function LabelRow(props: {
  label: LabelName;
  look: LabelLook;
  /** As it is seen. */
  color: string;
  open: boolean;
  onOpen(): void;
  onChange(by: Partial<LabelLook>, gesture?: string): void;
}) {
  const { label, look, color: shown, onChange } = props;
  const title = titleOf(label);
  const plain = look.color === undefined && look.material === undefined;
  return (
    <li class={look.hidden ? "hidden" : ""}>
      <div class="label-row">
        <IconButton
          icon={look.hidden ? "eye-off" : "eye"}
          label={look.hidden ? `Show ${title}` : `Hide ${title}`}
          pressed={!look.hidden}
          onClick={() => onChange({ hidden: !look.hidden })}
        />
        <span class={plain ? "swatch plain" : "swatch"} style={{ "--color": shown }} />
        <button
          type="button"
          class="name"
          aria-expanded={props.open}
          onClick={props.onOpen}
          title={`${title} (${label.value})`}
        >
          <span>{title}</span>
          <small>{look.material ?? ""}</small>
          <small class="number-of">{label.value}</small>
          <Icon name="chevron" size={10} />
        </button>
      </div>
      {props.open && (
        <div class="label-look">
          <Select
            label="Material"
            value={look.material ?? asItIs}
            options={[
              { value: asItIs, label: "As the curve has it" },
              ...materialNames().map((name) => ({ value: name, label: name })),
            ]}
            onChange={(name) => onChange({ material: name || undefined })}
          />
          <Toggle
            label="Color of its own"
            value={look.color !== undefined}
            onChange={(on) => onChange({ color: on ? shown : undefined })}
          />
          {look.color !== undefined && (
            <ColorField label="Color" value={shown} onChange={(color, gesture) => onChange({ color }, gesture)} />
          )}
          <Toggle
            label="Opacity of its own"
            hint="As opaque as this, whatever the data"
            value={look.opacity !== undefined}
            onChange={(on) => onChange({ opacity: on ? 0.95 : undefined, ...(on && plain ? { color: shown } : {}) })}
          />
          {look.opacity !== undefined && (
            <Slider
              label="Opacity"
              min={0.001}
              max={1}
              hardMin={1e-6}
              digits={3}
              value={look.opacity}
              onChange={(opacity, gesture) => onChange({ opacity }, gesture)}
            />
          )}
        </div>
      )}
    </li>
  );
}
