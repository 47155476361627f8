import { joinScale, splitScale } from "../../color";
import { directionField, facedPoint, positionField, worldDirection, worldPosition } from "../../geometry/light-place";
import { placed, placeOf, type LightPlace } from "../../model/light-motion";
import { edit, scene } from "../../state/scene";
import { frame } from "../../state/frame";
import type { Attachment, Light, Vec3 } from "../../state/scene-types";
import { ColorField, Field, NumberInput, Segmented, Toggle } from "../../ui/controls";
import { numberFields } from "../number-fields";

/** Name, range, unit and step of a light's numbers; where it is is told by direction and distance from the target. */
const LightNumber = numberFields("/lights", {
  intensity: { label: "Intensity", min: 0.01, max: 50, hardMin: 0, hardMax: 1e12, logarithmic: true, digits: 3 },
  azimuthDeg: { label: "Azimuth", unit: "°", min: -180, max: 180, digits: 1 },
  elevationDeg: { label: "Elevation", unit: "°", min: -89.9, max: 89.9, digits: 1 },
  distanceMm: { label: "Distance", hint: "From the point that the camera turns about", unit: "mm", min: 1, max: 5000, hardMin: 1e-6, hardMax: 1e9, logarithmic: true, digits: 1 },
});

/** Usual intensities differ by kind: a point's grows with the square of its distance. */
function intensityRange(light: Light, distance: number): { min: number; max: number } {
  if (light.kind === "directional") return { min: 0.01, max: 50 };
  if (light.kind === "rect") return { min: 0.1, max: 2000 };
  const one = Math.max(1, distance) ** 2;
  return { min: Number((0.01 * one).toPrecision(1)), max: Number((50 * one).toPrecision(1)) };
}

/** `light` attached to the other, and where it was: by the camera of the picture on screen. */
function reattached(light: Light, to: Attachment, target_mm: Vec3): Light {
  const seen = frame.peek()?.header.camera;
  if (!seen || light.attached_to === to) return { ...light, attached_to: to };
  const camera = { ...seen, target_mm };
  const { up: _, ...rest } = light;
  const out: Light = { ...rest, attached_to: to };
  if (light.direction) out.direction = directionField(out, worldDirection(light, camera), camera);
  if (light.position_mm) out.position_mm = positionField(out, worldPosition(light, camera), camera);
  if (light.target_mm) out.target_mm = positionField(out, facedPoint(light, camera), camera);
  return out;
}

/** Everything of the chosen light. */
export function LightFields({ light, index }: { light: Light; index: number }) {
  const at = `/lights/${index}`;
  const target = scene.value?.camera.target_mm ?? [0, 0, 0];
  const place = placeOf(light, target);
  const { hex, scale: beyond } = splitScale(light.color);
  const range = intensityRange(light, place.distanceMm);
  const move = (change: Partial<LightPlace>, gesture: string) => {
    const { field, value } = placed(light, { ...place, ...change }, target);
    edit([[`${at}/${field}`, value]], gesture);
  };
  return (
    <>
      <ColorField
        label="Color"
        value={hex}
        onChange={(value, gesture) => edit([[`${at}/color`, joinScale(value, beyond)]], gesture)}
      />
      <LightNumber at={at} of={light} name="intensity" {...range} />
      <Segmented
        label="Attached to"
        value={light.attached_to}
        options={[
          { value: "world", label: "World", hint: "Stands still when you turn the view" },
          { value: "camera", label: "Camera", hint: "Turns with the view" },
        ]}
        onChange={(to) => edit([[at, reattached(scene.peek()!.lights![index]!, to, target)]])}
      />
      <LightNumber
        of={place}
        name="azimuthDeg"
        hint={
          light.attached_to === "world"
            ? "0 is in front of the patient, 90 at the patient's left"
            : "0 is at the eye, 90 to the right"
        }
        onChange={(azimuthDeg, gesture) => move({ azimuthDeg }, gesture)} />
      <LightNumber of={place} name="elevationDeg" onChange={(elevationDeg, gesture) => move({ elevationDeg }, gesture)} />
      {light.kind !== "directional" && (
        <LightNumber of={place} name="distanceMm" onChange={(distanceMm, gesture) => move({ distanceMm }, gesture)} />
      )}
      {light.kind === "rect" && (
        <>
          <Field label="Size" hint="Larger lights make softer shadows">
            {[0, 1].map((i) => (
              <NumberInput
                key={i}
                label={i === 0 ? "Width" : "Height"}
                unit="mm"
                digits={1}
                min={1e-6}
                step={10}
                value={light.size_mm[i]!}
                onChange={(value, gesture) => edit([[`${at}/size_mm/${i}`, value]], gesture)}
              />
            ))}
          </Field>
          <Toggle label="Two-sided" value={light.two_sided} onChange={(on) => edit([[`${at}/two_sided`, on]])} />
        </>
      )}
    </>
  );
}
