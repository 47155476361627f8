import { useState } from "preact/hooks";
import { mostProxies } from "../../model/rules";
import { edit } from "../../state/scene";
import type { Proxy, Scene } from "../../state/scene-types";
import { tryEdit } from "../../state/tried-edit";
import { Button, Field, IconButton, Select, Slider, Toggle } from "../../ui/controls";
import { FilePicker } from "../file-picker";

/** A name that no other proxy has. */
export function freeName(of: Scene, wished: string): string {
  const taken = ["data", "opacity", ...of.proxies.map((proxy) => proxy.name)];
  if (!taken.includes(wished)) return wished;
  for (let n = 2; ; ++n) if (!taken.includes(`${wished}${n}`)) return `${wished}${n}`;
}

/** "folder/atlas.nii.gz" -> "atlas". */
export function nameOfPath(path: string): string {
  const stem = path
    .split("/")
    .at(-1)!
    .replace(/(\.nii|\.ome)?\.[^.]*$/, "");
  return stem || "volume";
}

/** A volume of a file that is not chosen yet. */
export const fileProxy = (name: string): Proxy => ({
  name,
  kind: "file",
  path: "",
  of: "data",
  sigma_mm: 2,
  labels: [],
  lookup: "linear",
  outline: "smooth",
});

const kinds: { value: Proxy["kind"]; label: string }[] = [
  { value: "gradient", label: "Gradient" },
  { value: "smoothed", label: "Smoothed" },
  { value: "distance", label: "Distance to labels" },
  { value: "file", label: "From a file" },
];

/** Adds a volume beside the data, for rules to read, unless it cannot be read itself; returns its name. */
export function addProxy(of: Scene, proxy: Partial<Proxy> & { name: string }): string {
  const name = freeName(of, proxy.name);
  void tryEdit([["/proxies/-", { ...fileProxy(name), ...proxy, name }]]);
  return name;
}

/** The volumes beside the data. */
export function Proxies({ of }: { of: Scene }) {
  const [picking, setPicking] = useState(false);
  const full = of.proxies.length >= mostProxies;
  const labels = of.proxies.filter((proxy) => proxy.lookup === "nearest");
  const add = (kind: Proxy["kind"]) => {
    if (kind === "file") return setPicking(true);
    if (kind === "distance") return void addProxy(of, { name: "distance", kind, of: labels[0]!.name, labels: [1] });
    addProxy(of, { name: kind === "gradient" ? "edges" : "smooth", kind });
  };
  return (
    <>
      {of.proxies.map((proxy, i) => (
        <ProxyFields key={proxy.name} of={of} proxy={proxy} index={i} />
      ))}
      {!full && (
        <div class="row-actions">
          {kinds.map(({ value, label }) => (
            <Button
              key={value}
              icon="add"
              disabled={value === "distance" && labels.length === 0}
              title={value === "distance" && labels.length === 0 ? "Needs a label volume" : undefined}
              onClick={() => add(value)}
            >
              {label}
            </Button>
          ))}
        </div>
      )}
      {full && <p class="note">A scene has up to {mostProxies} further volumes.</p>}
      {picking && (
        <FilePicker
          title="Add a volume"

          onClose={() => setPicking(false)}
          onPick={(path) => {
            setPicking(false);
            addProxy(of, { name: nameOfPath(path), path });
          }}
        />
      )}
    </>
  );
}

function ProxyFields({ of, proxy, index }: { of: Scene; proxy: Proxy; index: number }) {
  const at = `/proxies/${index}`;
  const used =
    of.transfer.rules.some((rule) => rule.volume === proxy.name || rule.along === proxy.name) ||
    of.proxies.some((other) => other.kind !== "file" && other.of === proxy.name) ||
    (of.visibility?.important ?? []).some((one) => one.volume === proxy.name || one.along === proxy.name);
  return (
    <div class="panel-card">
      <header>
        <strong>{proxy.name}</strong>
        <small title={proxy.path}>
          {proxy.kind === "file"
            ? proxy.path.split("/").at(-1)
            : `${kinds.find((k) => k.value === proxy.kind)!.label} of ${proxy.of}`}
        </small>
        <IconButton
          icon="delete"
          label={used ? `${proxy.name} is used by rules` : `Remove ${proxy.name}`}
          disabled={used}
          onClick={() => edit([[at, null]])}
        />
      </header>
      {proxy.kind === "smoothed" && (
        <Slider
          label="Sigma"
          unit="mm"
          min={0.2}
          max={20}
          hardMin={1e-6}
          hardMax={1e6}
          logarithmic
          value={proxy.sigma_mm}
          onChange={(value, gesture) => edit([[`${at}/sigma_mm`, value]], gesture)}
        />
      )}
      {proxy.kind === "distance" && (
        <>
          <Field label="Labels" hint="Numbers of the labels that are inside, with commas">
            <input
              class="text"
              type="text"
              aria-label="Labels that are inside"
              value={proxy.labels.join(", ")}
              onChange={(event) => {
                const labels = event.currentTarget.value
                  .split(/[\s,]+/)
                  .map(Number)
                  .filter((n) => Number.isInteger(n) && n !== 0);
                if (labels.length) edit([[`${at}/labels`, labels]]);
              }}
            />
          </Field>
        </>
      )}
      {proxy.kind === "file" && (
        <>
          <Toggle
            label="Labels"
            hint="Whole numbers that are never interpolated"
            value={proxy.lookup === "nearest"}
            disabled={used}
            onChange={(on) => edit([[`${at}/lookup`, on ? "nearest" : "linear"]])}
          />
          {proxy.lookup === "nearest" && (
            <Select
              label="Outline"
              value={proxy.outline}
              options={[
                { value: "smooth", label: "Smooth" },
                { value: "voxels", label: "Faces of voxels" },
              ]}
              onChange={(outline) => edit([[`${at}/outline`, outline]])}
            />
          )}
        </>
      )}
      {proxy.kind !== "file" && <NumberNote proxy={proxy} />}
    </div>
  );
}

function NumberNote({ proxy }: { proxy: Proxy }) {
  if (proxy.kind === "gradient")
    return <p class="note">Gradient magnitude, per mm: large at borders between tissues.</p>;
  if (proxy.kind === "distance")
    return <p class="note">Signed distance from the labels' border [mm], positive inside.</p>;
  return null;
}
