import { useState } from "preact/hooks";
import { toHex } from "../color";
import { edit, newGesture, scene } from "../state/scene";
import { hello } from "../state/session";
import type { Color, NamedMaterial, Scene } from "../state/scene-types";
import { Button, ColorField, IconButton, Section, Select, Slider, Toggle } from "../ui/controls";
import { Disclosure } from "../ui/disclosure";

/** How matter scatters. */
export function MaterialPanel() {
  const of = scene.value;
  if (!of) return null;
  return (
    <>
      <Section title="Shading">
        <ShadingFields of={of} />
      </Section>
      <Section title="Named materials" closed={of.materials.length === 0}>
        <NamedMaterials of={of} />
      </Section>
    </>
  );
}

function ShadingFields({ of }: { of: Scene }) {
  const m = of.material;
  const blinn = m.shading === "blinn-phong";
  const set = (name: string) => (value: number, gesture: string) => edit([[`/material/${name}`, value]], gesture);
  return (
    <>
      <Select
        label="Shading"
        value={m.shading}
        options={[
          {
            value: "coexistence",
            label: "Surface and medium",
            hint: "Every collision is both, weighted by their shares",
          },
          {
            value: "er",
            label: "One of the two by chance",
            hint: "As in Exposure Render: the same picture, more noise",
          },
          { value: "phase", label: "Medium alone" },
          { value: "brdf", label: "Surface alone" },
          { value: "blinn-phong", label: "Blinn-Phong" },
        ]}
        onChange={(shading) => edit([["/material/shading", shading]])}
      />
      <Slider
        label="Gradient factor"
        hint="How soon a gradient makes a surface"
        min={0}
        max={3}
        hardMax={1000}
        step={0.01}
        initial={0.5}
        value={m.gradient_factor}
        onChange={set("gradient_factor")}
      />
      <Slider
        label="Roughness"
        min={0}
        max={1}
        step={0.01}
        initial={0.4}
        disabled={blinn}
        value={m.roughness}
        onChange={set("roughness")}
      />
      <Slider
        label="Specular"
        hint="Reflectance at normal incidence is 0.08 times this"
        min={0}
        max={1}
        step={0.01}
        initial={0.5}
        disabled={blinn}
        value={m.specular}
        onChange={set("specular")}
      />
      <Slider
        label="Anisotropy"
        hint="Of the medium: above 0 light goes on, below 0 back"
        min={-0.99}
        max={0.99}
        step={0.01}
        initial={0}
        value={m.anisotropy}
        onChange={set("anisotropy")}
      />
      <Slider
        label="Self-occlusion"
        hint="Below 1 brightens what shadows itself; 1 is physical"
        min={0.01}
        max={1}
        step={0.01}
        initial={1}
        value={m.self_occlusion}
        onChange={set("self_occlusion")}
      />
      {blinn && (
        <>
          <Slider
            label="Highlight"
            min={0}
            max={10}
            hardMax={1000}
            step={0.05}
            initial={1}
            value={m.highlight}
            onChange={set("highlight")}
          />
          <Slider
            label="Shininess"
            min={1}
            max={500}
            hardMin={0}
            hardMax={10000}
            logarithmic
            digits={0}
            initial={40}
            value={m.shininess}
            onChange={set("shininess")}
          />
        </>
      )}
      <Disclosure label="More">
        <Select
          label="Surface share"
          hint="How the share of the surface follows from gradient and opacity"
          value={m.surface_share}
          options={[
            { value: "hybrid", label: "Hybrid" },
            { value: "exponential", label: "Exponential" },
            { value: "modulation", label: "Modulation" },
            { value: "threshold", label: "Threshold" },
          ]}
          onChange={(form) => edit([["/material/surface_share", form]])}
        />
        <Toggle
          label="Modulated by opacity"
          value={m.opacity_modulated}
          disabled={m.surface_share !== "hybrid"}
          onChange={(on) => edit([["/material/opacity_modulated", on]])}
        />
        <Select
          label="Lobes"
          value={m.lobes}
          options={[
            { value: "auto", label: "Automatic" },
            { value: "reciprocal", label: "Reciprocal" },
            { value: "particles", label: "Particles" },
          ]}
          onChange={(lobes) => edit([["/material/lobes", lobes]])}
        />
        {of.transfer.rules.length > 0 && (
          <Toggle
            label="Smooth borders of labels"
            value={of.transfer.smooth_labels}
            onChange={(on) => edit([["/transfer/smooth_labels", on]])}
          />
        )}
      </Disclosure>
    </>
  );
}

const numbers: readonly { key: string; label: string; min: number; max: number; initial: number }[] = [
  { key: "opacity", label: "Opacity", min: 0, max: 1, initial: 0.9 },
  { key: "roughness", label: "Roughness", min: 0, max: 1, initial: 0.4 },
  { key: "metallic", label: "Metallic", min: 0, max: 1, initial: 1 },
  { key: "specular", label: "Specular", min: 0, max: 1, initial: 0.5 },
  { key: "anisotropy", label: "Anisotropy", min: -0.99, max: 0.99, initial: 0.5 },
  { key: "surface_share", label: "Surface share", min: 0, max: 1, initial: 1 },
  { key: "transmission", label: "Transmission", min: 0, max: 1, initial: 1 },
  { key: "ior", label: "Index of refraction", min: 1, max: 4, initial: 1.5 },
  { key: "diffuse_roughness", label: "Diffuse roughness", min: 0, max: 1, initial: 0.5 },
];

/** Materials of the scene, for labels and rules to name. */
function NamedMaterials({ of }: { of: Scene }) {
  const library = hello.value?.materials ?? [];
  const [like, setLike] = useState("lesion");
  const names = [...of.materials, ...library].map((m) => m.name);
  const add = () => {
    let n = 2;
    while (names.includes(`${like}-${n}`)) ++n;
    edit([["/materials/-", { name: `${like}-${n}`, like }]], newGesture("material"));
  };
  return (
    <>
      <p class="note">Materials that labels and rules may name, beside those of the library.</p>
      {of.materials.map((material, i) => (
        <MaterialCard key={material.name} of={of} material={material} index={i} />
      ))}
      <Select
        label="Like"
        value={like}
        options={library.map((m) => ({ value: m.name, label: m.name, hint: m.summary }))}
        onChange={setLike}
      />
      <div class="row-actions">
        <Button icon="add" onClick={add}>
          Add a material
        </Button>
      </div>
    </>
  );
}

function MaterialCard({ of, material, index }: { of: Scene; material: NamedMaterial; index: number }) {
  const at = `/materials/${index}`;
  const used = JSON.stringify(of.transfer.rules).includes(`"material":${JSON.stringify(material.name)}`);
  const library = hello.value?.materials.find((one) => one.name === material.like);
  const color = material["color"] as Color | undefined;
  const given = numbers.filter(({ key }) => material[key] !== undefined);
  const open = numbers.filter(({ key }) => material[key] === undefined);
  return (
    <div class="panel-card">
      <header>
        <strong>{material.name}</strong>
        <small>{material.like ? `like ${material.like}` : ""}</small>
        <IconButton
          icon="delete"
          label={used ? `${material.name} is used by rules` : `Remove ${material.name}`}
          disabled={used}
          onClick={() => edit([[at, null]])}
        />
      </header>
      <ColorField
        label="Color"
        value={color ? toHex(color) : (library?.color ?? "#cccccc")}
        onChange={(value, gesture) => edit([[`${at}/color`, value]], gesture)}
      />
      {given.map(({ key, label, min, max }) => (
        <div class="optional" key={key}>
          <div class="optional-body">
            <Slider
              label={label}
              min={min}
              max={max}
              step={0.01}
              value={material[key] as number}
              onChange={(value, gesture) => edit([[`${at}/${key}`, value]], gesture)}
            />
          </div>
          <IconButton
            icon="close"
            label={`${label} as ${material.like || "the scene"} has it`}
            onClick={() => edit([[`${at}/${key}`, null]])}
          />
        </div>
      ))}
      {open.length > 0 && (
        <Select
          label="Set"
          value=""
          options={[{ value: "", label: "…" }, ...open.map(({ key, label }) => ({ value: key, label }))]}
          onChange={(key) => key && edit([[`${at}/${key}`, numbers.find((n) => n.key === key)!.initial]])}
        />
      )}
    </div>
  );
}
