import { setSplit, hello, split } from "../state/session";
import { edit, scene } from "../state/scene";
import { Field, NumberInput, Section, Segmented, Select, Toggle } from "../ui/controls";
import { Disclosure } from "../ui/disclosure";
import { numberFields } from "./number-fields";

/** Name, range, unit and step of what the picture and its rendering count. */
const ImageNumber = numberFields("/image", {
  exposure_ev: { label: "Exposure", unit: "EV", min: -5, max: 5, hardMin: -64, hardMax: 64, step: 0.05, initial: 0 },
  spp: { label: "Samples a pixel", hint: "The still picture is done after so many", min: 1, max: 16384, hardMax: 1e9, logarithmic: true, digits: 0, whole: true },
  noise: { label: "Noise", hint: "Mean of standard error over luminance", min: 0.001, max: 0.3, hardMax: 1e6, logarithmic: true, digits: 4 },
});
const RenderNumber = numberFields("/render", {
  max_scatter: { label: "Scatterings of a path", hint: "1 is direct light; more is softer, and slower", min: 1, max: 64, hardMax: 1e6, logarithmic: true, digits: 0, whole: true },
  light_samples: { label: "Shadow rays", hint: "At the first scattering of a path", min: 1, max: 64, logarithmic: true, digits: 0, whole: true },
});

const integrators = [
  { value: "path", label: "Path tracing" },
  { value: "ray-march", label: "Ray marching" },
  { value: "exposure-render", label: "As Exposure Render" },
  { value: "rmss", label: "As RMSS" },
  { value: "vpl-dvr", label: "As VPL-DVR" },
  { value: "ar2t", label: "As AR2T" },
];

/** How the light is computed and the picture developed. */
export function RenderPanel() {
  const of = scene.value;
  if (!of) return null;
  const { render, image } = of;
  const denoisers = [
    { name: "none", summary: "The plain picture" },
    ...(hello.value?.denoisers ?? []).filter((d) => d.name !== "none"),
  ];
  return (
    <>
      <Section title="Picture">
        <ImageNumber of={image} name="exposure_ev" />
        <Segmented
          label="Tone curve"
          value={image.tone_curve}
          options={[
            { value: "filmic", label: "Filmic", hint: "Bright light is compressed" },
            { value: "srgb", label: "Linear", hint: "sRGB: bright light is cut off" },
          ]}
          onChange={(curve) => edit([["/image/tone_curve", curve]])}
        />
      </Section>
      <Section title="Denoiser">
        <Select
          label="Method"
          value={render.denoise}
          hint={denoisers.find((d) => d.name === render.denoise)?.summary}
          options={denoisers.map(({ name, summary }) => ({
            value: name,
            label: name === "none" ? "None" : name,
            hint: summary,
          }))}
          onChange={(name) => edit([["/render/denoise", name]])}
        />
        <p class="note">{denoisers.find((d) => d.name === render.denoise)?.summary}</p>
        <Toggle
          label="Compare with the plain picture"
          hint="Left of the split the picture is shown without denoiser"
          value={split.value !== null}
          disabled={render.denoise === "none"}
          onChange={(on) => setSplit(on ? 0.5 : null)}
        />
      </Section>
      <Section title="Quality">
        <ImageNumber name="spp" value={image.spp ?? 16384} />
        <Toggle
          label="Stop at a noise"
          hint="Or when the noise is this low"
          value={image.noise !== undefined}
          onChange={(on) => edit([["/image/noise", on ? 0.02 : null]])}
        />
        {image.noise !== undefined && (
          <ImageNumber of={image} name="noise" />
        )}
        <RenderNumber name="max_scatter" value={render.max_scatter || 64} disabled={render.max_scatter === 0} />
        <Toggle
          label="Unlimited scatterings"
          value={render.max_scatter === 0}
          onChange={(on) => edit([["/render/max_scatter", on ? 0 : 2]])}
        />
        <Disclosure label="More">
          <Select
            label="Integrator"
            value={render.integrator}
            options={integrators}
            onChange={(name) => edit([["/render/integrator", name]])}
          />
          <RenderNumber of={render} name="light_samples" />
          <Field label="Seed">
            <NumberInput
              label="Seed"
              min={0}
              digits={0}
              value={render.seed}
              onChange={(value) => edit([["/render/seed", Math.round(value)]])}
            />
          </Field>
        </Disclosure>
      </Section>
    </>
  );
}
