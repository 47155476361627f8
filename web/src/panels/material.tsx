import { useState } from "preact/hooks";
import { toHex } from "../color";
import { edit, newGesture, scene } from "../state/scene";
import { hello } from "../state/session";
import type { Color, NamedMaterial, Scene } from "../state/scene-types";
import { Button, ColorField, IconButton, Section, Select, Toggle } from "../ui/controls";
import { Disclosure } from "../ui/disclosure";
import { numberFields } from "./number-fields";

/** Name, range and step of the numbers of how all matter scatters. */
const MaterialNumber = numberFields("/material", {
  gradient_factor: { label: "Gradient factor", hint: "How soon a gradient makes a surface", min: 0, max: 3, hardMax: 1000, step: 0.01, initial: 0.5 },
  roughness: { label: "Roughness", min: 0, max: 1, step: 0.01, initial: 0.4 },
  specular: { label: "Specular", hint: "Reflectance at normal incidence is 0.08 times this", min: 0, max: 1, step: 0.01, initial: 0.5 },
  anisotropy: { label: "Anisotropy", hint: "Of the medium: above 0 light goes on, below 0 back", min: -0.99, max: 0.99, step: 0.01, initial: 0 },
  self_occlusion: { label: "Self-occlusion", hint: "Below 1 brightens what shadows itself; 1 is physical", min: 0.01, max: 1, step: 0.01, initial: 1 },
  highlight: { label: "Highlight", min: 0, max: 10, hardMax: 1000, step: 0.05, initial: 1 },
  shininess: { label: "Shininess", min: 1, max: 500, hardMin: 0, hardMax: 10000, logarithmic: true, digits: 0, initial: 40 },
});

/** The same of one named material, which may leave each of them to what it is like. */
const coefficients = {
  opacity: { label: "Opacity", min: 0, max: 1, step: 0.01, initial: 0.9 },
  roughness: { label: "Roughness", min: 0, max: 1, step: 0.01, initial: 0.4 },
  metallic: { label: "Metallic", min: 0, max: 1, step: 0.01, initial: 1 },
  specular: { label: "Specular", min: 0, max: 1, step: 0.01, initial: 0.5 },
  anisotropy: { label: "Anisotropy", min: -0.99, max: 0.99, step: 0.01, initial: 0.5 },
  surface_share: { label: "Surface share", min: 0, max: 1, step: 0.01, initial: 1 },
  transmission: { label: "Transmission", min: 0, max: 1, step: 0.01, initial: 1 },
  ior: { label: "Index of refraction", min: 1, max: 4, step: 0.01, initial: 1.5 },
  diffuse_roughness: { label: "Diffuse roughness", min: 0, max: 1, step: 0.01, initial: 0.5 },
};
const CoefficientNumber = numberFields("/materials", coefficients);
const coefficientNames = Object.keys(coefficients) as (keyof typeof coefficients)[];

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
      <MaterialNumber of={m} name="gradient_factor" />
      <MaterialNumber of={m} name="roughness" disabled={blinn} />
      <MaterialNumber of={m} name="specular" disabled={blinn} />
      <MaterialNumber of={m} name="anisotropy" />
      <MaterialNumber of={m} name="self_occlusion" />
      {blinn && (
        <>
          <MaterialNumber of={m} name="highlight" />
          <MaterialNumber of={m} name="shininess" />
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
  const given = coefficientNames.filter((name) => material[name] !== undefined);
  const open = coefficientNames.filter((name) => material[name] === undefined);
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
      {given.map((name) => (
        <div class="optional" key={name}>
          <div class="optional-body">
            <CoefficientNumber at={at} name={name} value={material[name] as number} />
          </div>
          <IconButton
            icon="close"
            label={`${coefficients[name].label} as ${material.like || "the scene"} has it`}
            onClick={() => edit([[`${at}/${name}`, null]])}
          />
        </div>
      ))}
      {open.length > 0 && (
        <Select
          label="Set"
          value=""
          options={[{ value: "", label: "…" }, ...open.map((name) => ({ value: name, label: coefficients[name].label }))]}
          onChange={(name) => name && edit([[`${at}/${name}`, coefficients[name].initial]])}
        />
      )}
    </div>
  );
}
