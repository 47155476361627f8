import { crosshair } from "../../state/crosshair";
import { edit, newGesture, scene } from "../../state/scene";
import type { Importance, Proxy, Scene, Visibility } from "../../state/scene-types";
import { labels, volume } from "../../state/volume";
import { mostProxies } from "../../model/rules";
import { Button, Field, IconButton, NumberInput, Section, Segmented, Select, Toggle } from "../../ui/controls";
import { pickPoint } from "../../view/pick";
import { useDomain } from "../transfer/domain";
import { freeName } from "../transfer/proxies";
import { RangeHistogram } from "./range-histogram";
import { numberFields } from "../number-fields";

/** Name, range, unit and step of how much gives way. */
const VisibilityNumber = numberFields("/visibility", {
  q: { label: "Before the important (q)", min: 0.1, max: 10000, hardMin: 0, hardMax: 1e6, logarithmic: true, digits: 2, initial: 70 },
  r: { label: "Behind the important (r)", min: 0.1, max: 10000, hardMin: 0, hardMax: 1e6, logarithmic: true, digits: 2, initial: 30 },
  p: { label: "Keeping matter (p)", min: 0.01, max: 100, hardMin: 1e-6, hardMax: 1e6, logarithmic: true, digits: 3, initial: 1 },
  lambda: { label: "Protection (lambda)", hint: "How much importance protects matter itself; 0: not at all", min: 0, max: 5, hardMax: 100, step: 0.05, initial: 1 },
});
/** The same of one thing that is important. */
const ImportanceNumber = numberFields("/visibility/important", {
  importance: { label: "Importance", min: 0, max: 1, step: 0.01, initial: 1 },
  radius_mm: { label: "Radius", unit: "mm", min: 1, max: 200, hardMin: 1e-6, hardMax: 1e6, logarithmic: true, digits: 1 },
});

/** As the scene reference has them. */
const initial: Visibility = {
  important: [],
  p: 1,
  q: 70,
  r: 30,
  lambda: 1,
  lights: "off",
  light_samples: 200,
  ray_samples: 48,
  ray_passes: 16,
  lookup: "interpolated",
  sums: "integral",
};
/** Everything inside the border of labels: a distance has no end that matters. */
const inside = [0, 1e12] as const;

let remembered: Visibility | null = null;

/** What stays in view, and how much gives way to it. */
export function VisibilityPanel() {
  const of = scene.value;
  const facts = volume.value;
  if (!of || !facts) return null;
  const { visibility } = of;
  const entries = visibility?.important ?? [];
  const add = (entry: Importance, before: [string, unknown][] = []) => {
    const next = { ...(visibility ?? remembered ?? initial), important: [...entries, entry] };
    edit([...before, ["/visibility", next]], newGesture("important"));
  };
  const labelVolumes = of.proxies.filter((proxy) => proxy.lookup === "nearest");
  const addRange = () => {
    const { "95": from = facts.range[0] } = facts.percentiles;
    add({ importance: 1, volume: "data", along: "", range: [facts.hounsfield ? 300 : from, facts.range[1]] });
  };
  const addLabel = () => {
    const atlas = labelVolumes[0]!;
    const label = labels.peek()[atlas.name]?.find((one) => one.value !== 0)?.value ?? 1;
    const name = freeName(of, `near-${atlas.name}`);
    const proxy: Proxy = {
      name,
      kind: "distance",
      path: "",
      of: atlas.name,
      sigma_mm: 1,
      labels: [label],
      lookup: "linear",
      outline: "smooth",
    };
    add({ importance: 1, volume: name, along: "", range: inside }, [["/proxies/-", proxy]]);
  };
  const addRegion = () => {
    const radius = Number(((of.camera.fit_radius_mm ?? 100) / 4).toPrecision(2));
    add({ importance: 1, volume: "data", along: "", center_mm: crosshair.value ?? [0, 0, 0], radius_mm: radius });
  };
  const toggle = (on: boolean) => {
    if (visibility) remembered = visibility;
    if (!on) return edit([["/visibility", null]], newGesture("visibility"));
    if (remembered) return edit([["/visibility", remembered]], newGesture("visibility"));
    addRange();
  };
  return (
    <>
      <Section title="What is important">
        <p class="note">What hides the important from the eye becomes transparent just enough.</p>
        <Toggle label="Keep the important in view" value={visibility !== undefined} onChange={toggle} />
        {entries.map((entry, i) => (
          <ImportanceCard key={i} of={of} entry={entry} index={i} />
        ))}
        <div class="row-actions">
          <Button icon="add" onClick={addRange}>
            Values
          </Button>
          <Button
            icon="add"
            disabled={labelVolumes.length === 0 || of.proxies.length >= mostProxies}
            title={labelVolumes.length === 0 ? "Needs a label volume" : undefined}
            onClick={addLabel}
          >
            Labels
          </Button>
          <Button icon="add" onClick={addRegion}>
            Region
          </Button>
        </div>
      </Section>
      {visibility && (
        <Section title="How much gives way">
          <VisibilityNumber of={visibility} name="q" />
          <VisibilityNumber of={visibility} name="r" />
          <VisibilityNumber of={visibility} name="p" />
          <VisibilityNumber of={visibility} name="lambda" />
          <Segmented
            label="Light, too"
            value={visibility.lights}
            hint="Whether light reaches the important as if little stood before it"
            options={[
              { value: "off", label: "No" },
              { value: "first", label: "First", hint: "At the first scattering of a path" },
              { value: "all", label: "All" },
            ]}
            onChange={(lights) => edit([["/visibility/lights", lights]])}
          />
        </Section>
      )}
    </>
  );
}

/** Whether two entries hold at the same points. */
function samePlace(a: Importance, b: Importance): boolean {
  return JSON.stringify({ ...a, importance: 1 }) === JSON.stringify({ ...b, importance: 1 });
}

function ImportanceCard({ of, entry, index }: { of: Scene; entry: Importance; index: number }) {
  const at = `/visibility/important/${index}`;
  const proxy = of.proxies.findIndex((one) => one.name === entry.volume);
  const isLabels = of.proxies[proxy]?.kind === "distance";
  const isRegion = entry.center_mm !== undefined;
  const twin = of.visibility!.important.findIndex((other) => samePlace(other, entry));
  const title = isRegion ? "Region" : isLabels ? `Labels of ${of.proxies[proxy]!.of}` : "Values";
  return (
    <div class="panel-card">
      <header>
        <strong>{title}</strong>
        <small />
        <IconButton icon="delete" label="Remove" onClick={() => edit([[at, null]], newGesture("important"))} />
      </header>
      {twin < index && (
        <p class="note">The same as number {twin + 1} above: the greater importance of the two counts.</p>
      )}
      {isLabels && <LabelChoice of={of} proxy={proxy} />}
      {isRegion && <Region entry={entry} at={at} />}
      {!isLabels && !isRegion && <Values of={of} entry={entry} at={at} />}
      <ImportanceNumber at={at} of={entry} name="importance" />
    </div>
  );
}

function Values({ of, entry, at }: { of: Scene; entry: Importance; at: string }) {
  const domain = useDomain(entry.volume);
  const range = entry.range ?? [domain.span.lo, domain.span.hi];
  const names = ["data", ...of.proxies.filter((proxy) => proxy.lookup !== "nearest").map((proxy) => proxy.name)];
  const set = (value: readonly [number, number], gesture: string) => edit([[`${at}/range`, value]], gesture);
  return (
    <>
      {names.length > 1 && (
        <Select
          label="Of"
          value={entry.volume}
          options={names.map((name) => ({ value: name, label: name === "data" ? "The data" : name }))}
          onChange={(name) =>
            edit(
              [
                [`${at}/volume`, name],
                [`${at}/range`, null],
              ],
              newGesture("important"),
            )
          }
        />
      )}
      <RangeHistogram label="Values that are important" domain={domain} range={range} onChange={set} />
      <Field label="From, to">
        <NumberInput
          label="From"
          digits={2}
          value={range[0]}
          max={range[1]}
          onChange={(value, gesture) => set([value, range[1]], gesture)}
        />
        <NumberInput
          label="To"
          digits={2}
          unit={domain.unit}
          value={range[1]}
          min={range[0]}
          onChange={(value, gesture) => set([range[0], value], gesture)}
        />
      </Field>
    </>
  );
}

/** The labels of a distance proxy: chosen one by one. */
function LabelChoice({ of, proxy }: { of: Scene; proxy: number }) {
  const chosen = of.proxies[proxy]!;
  const names = (labels.value[chosen.of] ?? []).filter((label) => label.value !== 0);
  const title = (value: number) =>
    names.find((label) => label.value === value)?.name.replaceAll("_", " ") || `Label ${value}`;
  const set = (next: number[]) => edit([[`/proxies/${proxy}/labels`, next]], newGesture("important-labels"));
  return (
    <>
      <div class="chips">
        {chosen.labels.map((value) => (
          <button
            key={value}
            type="button"
            class="chip"
            disabled={chosen.labels.length === 1}
            aria-label={`Remove ${title(value)}`}
            title="Remove"
            onClick={() => set(chosen.labels.filter((other) => other !== value))}
          >
            {title(value)}
          </button>
        ))}
      </div>
      <Select
        label="Add"
        value=""
        options={[
          { value: "", label: "…" },
          ...names
            .filter((label) => !chosen.labels.includes(label.value))
            .map((label) => ({ value: String(label.value), label: title(label.value) })),
        ]}
        onChange={(value) => value && set([...chosen.labels, Number(value)].sort((a, b) => a - b))}
      />
    </>
  );
}

function Region({ entry, at }: { entry: Importance; at: string }) {
  const center = entry.center_mm!;
  const box = entry.size_mm !== undefined;
  const shape = (kind: string) =>
    kind === "box"
      ? edit(
          [
            [`${at}/size_mm`, Array(3).fill(2 * (entry.radius_mm ?? 20))],
            [`${at}/radius_mm`, null],
          ],
          newGesture("region"),
        )
      : edit(
          [
            [`${at}/radius_mm`, Math.max(...entry.size_mm!) / 2],
            [`${at}/size_mm`, null],
          ],
          newGesture("region"),
        );
  const setCenter = (p: readonly number[], gesture: string) => edit([[`${at}/center_mm`, p]], gesture);
  return (
    <>
      <Segmented
        label="Shape"
        value={box ? "box" : "sphere"}
        options={[
          { value: "sphere", label: "Sphere" },
          { value: "box", label: "Box" },
        ]}
        onChange={shape}
      />
      <Field label="Middle" hint="mm toward the patient's sides: R or L, A or P, I or S">
        {([0, 1, 2] as const).map((i) => (
          <NumberInput
            key={i}
            label={`Middle ${"xyz"[i]}`}
            axis={i}
            value={center[i]!}
            onChange={(value, gesture) =>
              setCenter(
                center.map((x, k) => (k === i ? value : x)),
                gesture,
              )
            }
          />
        ))}
      </Field>
      {box ? (
        <Field label="Size">
          {[0, 1, 2].map((i) => (
            <NumberInput
              key={i}
              label={`Size ${"xyz"[i]}`}
              unit="mm"
              digits={1}
              min={1e-6}
              value={entry.size_mm![i]!}
              onChange={(value, gesture) =>
                edit([[`${at}/size_mm`, entry.size_mm!.map((x, k) => (k === i ? value : x))]], gesture)
              }
            />
          ))}
        </Field>
      ) : (
        <ImportanceNumber at={at} name="radius_mm" value={entry.radius_mm ?? 20} />
      )}
      <div class="row-actions">
        <Button
          title="The point that the slices mark"
          onClick={() => crosshair.value && setCenter(crosshair.value, newGesture("region"))}
        >
          At the crosshair
        </Button>
        <Button
          title="Click a point in the picture"
          onClick={() =>
            void pickPoint().then(
              (answer) => answer?.position_mm && setCenter(answer.position_mm, newGesture("region")),
            )
          }
        >
          Pick in the picture
        </Button>
      </div>
    </>
  );
}
