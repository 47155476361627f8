import type { ComponentChildren } from "preact";
import { joinScale, splitScale, toHex } from "../../color";
import {
  colorAt,
  numberAt,
  opacityAt,
  pointOpacity,
  usesExtinction,
  withCoefficient,
  withOpacity,
  type NumberKey,
} from "../../model/curve";
import { isDiscreteKind, isMaterialKind } from "../../model/rules";
import { hello } from "../../state/session";
import { newGesture, scene } from "../../state/scene";
import type { Rule, TransferPoint } from "../../state/scene-types";
import { ColorField, Field, IconButton, NumberInput, Select, Slider, Toggle } from "../../ui/controls";
import { Disclosure } from "../../ui/disclosure";
import type { Domain } from "./domain";

interface PointFieldsProps {
  points: readonly TransferPoint[];
  index: number;
  kind: Rule["kind"];
  domain: Domain;
  referenceMm: number;
  onChange(point: TransferPoint, gesture: string): void;
}

const coefficients: readonly { key: NumberKey; label: string; min: number; max: number; initial: number; hint: string }[] = [
  { key: "roughness", label: "Roughness", min: 0, max: 1, initial: 0.4, hint: "Of the surface: 0 is polished, 1 dull" },
  { key: "metallic", label: "Metallic", min: 0, max: 1, initial: 1, hint: "Share of metal in the surface" },
  { key: "specular", label: "Specular", min: 0, max: 1, initial: 0.5, hint: "Reflectance at normal incidence is 0.08 times this" },
  { key: "anisotropy", label: "Anisotropy", min: -0.99, max: 0.99, initial: 0.5, hint: "Of the medium: above 0 light goes on, below 0 back" },
  { key: "surface_share", label: "Surface share", min: 0, max: 1, initial: 0.5, hint: "Multiplies the surface that gradients make; 0: medium alone" },
];

/** Materials that rules may name: the scene's own, then the library's. */
export function materialNames(): string[] {
  const own = (scene.value?.materials ?? []).map((material) => material.name);
  return [...own, ...(hello.value?.materials ?? []).map((m) => m.name).filter((name) => !own.includes(name))];
}

/** Exact numbers and colors of the chosen point. */
export function PointFields({ points, index, kind, domain, referenceMm, onChange }: PointFieldsProps) {
  const point = points[index];
  if (!point) return null;
  const extinction = point.mu_t_per_mm !== undefined || usesExtinction(points);
  const opacity = pointOpacity(point, referenceMm);
  const step = isDiscreteKind(kind) ? 1 : (domain.span.hi - domain.span.lo) / 1000;
  const lo = index > 0 ? points[index - 1]!.value : -Infinity;
  const hi = index + 1 < points.length ? points[index + 1]!.value : Infinity;
  const color = colorAt(points, point.value);
  return (
    <div class="point-fields" key={index}>
      <div class="point-row">
        <span class="captioned">
          <span>Value</span>
          <NumberInput
            label="Value of the point"
            value={point.value}
            min={lo}
            max={hi}
            step={step}
            digits={isDiscreteKind(kind) ? 0 : Math.max(0, Math.ceil(1 - Math.log10(step * 100)))}
            unit={domain.unit}
            onChange={(value, gesture) => onChange({ ...point, value }, gesture)}
          />
        </span>
        <span class="captioned">
          <span>Opacity</span>
          <NumberInput
            label="Opacity of the point"
            value={opacity ?? opacityAt(points, point.value, referenceMm)}
            min={0}
            max={1}
            step={0.01}
            digits={4}
            onChange={(value, gesture) => onChange(withOpacity(point, value, extinction, referenceMm), gesture)}
          />
        </span>
        <span class="captioned">
          <span>Color</span>
          <ColorField
            bare
            label="Color of the point"
            value={point.color ? toHex(point.color) : color ? toHex({ linear: color }) : "#cccccc"}
            onChange={(value, gesture) => onChange({ ...point, color: value }, gesture)}
          />
        </span>
      </div>
      {isMaterialKind(kind) && (
        <Select
          label="Material"
          value={point.material ?? ""}
          options={materialNames().map((name) => ({ value: name, label: name }))}
          onChange={(material) => onChange({ ...point, material }, newGesture("material"))}
        />
      )}
      <Disclosure label="More of this point">
        {extinction && (
          <Field label="Extinction" hint="Instead of an opacity">
            <NumberInput
              label="Extinction"
              unit="/mm"
              digits={5}
              min={0}
              step={0.01}
              value={point.mu_t_per_mm ?? numberAt(points, point.value, "mu_t_per_mm") ?? 0}
              onChange={(value, gesture) => onChange({ ...point, mu_t_per_mm: value }, gesture)}
            />
          </Field>
        )}
        {coefficients.map((c) => (
          <Optional
            key={c.key}
            label={c.label}
            hint={c.hint}
            given={point[c.key] !== undefined}
            onGiven={(given) =>
              onChange(
                withCoefficient(point, c.key, given ? (numberAt(points, point.value, c.key) ?? c.initial) : undefined),
                newGesture("coefficient"),
              )
            }
          >
            <Slider
              label={c.label}
              min={c.min}
              max={c.max}
              step={0.01}
              value={point[c.key] ?? 0}
              onChange={(value, gesture) => onChange({ ...point, [c.key]: value }, gesture)}
            />
          </Optional>
        ))}
        <Optional
          label="Emission"
          hint="Light that an opaque region would glow with"
          given={point.emission !== undefined}
          onGiven={(given) =>
            onChange(withCoefficient(point, "emission", given ? { linear: [0.2, 0.07, 0.02] } : undefined), newGesture("coefficient"))
          }
        >
          <Emission point={point} onChange={onChange} />
        </Optional>
      </Disclosure>
    </div>
  );
}

function Emission({ point, onChange }: { point: TransferPoint; onChange: PointFieldsProps["onChange"] }) {
  const { hex, scale } = splitScale(point.emission ?? "#000000");
  return (
    <>
      <ColorField
        label="Emission"
        value={hex}
        onChange={(value, gesture) => onChange({ ...point, emission: joinScale(value, scale) }, gesture)}
      />
      <Slider
        label="Strength"
        min={1}
        max={100}
        hardMax={10000}
        logarithmic
        value={scale}
        onChange={(value, gesture) => onChange({ ...point, emission: joinScale(hex, value) }, gesture)}
      />
    </>
  );
}

/** A coefficient that a point may give or leave to its neighbours. */
function Optional(props: {
  label: string;
  hint: string;
  given: boolean;
  onGiven(given: boolean): void;
  children: ComponentChildren;
}) {
  return props.given ? (
    <div class="optional" title={props.hint}>
      <div class="optional-body">{props.children}</div>
      <IconButton
        icon="close"
        label={`Leave ${props.label.toLowerCase()} to the other points`}
        onClick={() => props.onGiven(false)}
      />
    </div>
  ) : (
    <Toggle label={props.label} hint={props.hint} value={false} onChange={props.onGiven} />
  );
}
