import { joinScale, splitScale, toHex } from "../../color";
import { pickEnvironmentMap } from "../../shell/files";
import { upload } from "../../shell/upload";
import { edit } from "../../state/scene";
import { hello } from "../../state/session";
import type { Scene } from "../../state/scene-types";
import { Button, ColorField, Segmented, Select, Toggle } from "../../ui/controls";
import { numberFields } from "../number-fields";

/** Name, range, unit and step of the environment's numbers. */
const EnvironmentNumber = numberFields("/environment", {
  intensity: { label: "Intensity", min: 0, max: 5, hardMax: 1e9, digits: 3 },
  rotation_deg: { label: "Rotation", unit: "°", min: -180, max: 180, hardMin: -36000, hardMax: 36000, digits: 1, initial: 0 },
});
const BackgroundNumber = numberFields("/camera", {
  background_blur_deg: { label: "Blur", unit: "°", min: 0, max: 45, digits: 1 },
});

/** Light from everywhere. */
export function EnvironmentFields({ of }: { of: Scene }) {
  const environment = of.environment;
  if (!environment) return null;
  const known = hello.value?.environments ?? [];
  // The path may be written in another form than is listed, and a picture of this computer be called as a listed one.
  const inFolder = (path: string) => path.split("/").slice(-2).join("/");
  const listed = known.find(({ path }) => path === environment.image || inFolder(path) === inFolder(environment.image));
  const options = [
    { value: "", label: "Constant color" },
    ...known.map(({ name, path }) => ({ value: path, label: name })),
    ...(environment.image && !listed
      ? [{ value: environment.image, label: environment.image.split("/").at(-1)! }]
      : []),
  ];
  const { hex, scale } = splitScale(environment.color);
  return (
    <>
      <Select
        label="Picture"
        value={listed?.path ?? environment.image}
        options={options}
        onChange={(image) => edit([["/environment/image", image]])}
      />
      <div class="row-actions">
        <Button
          icon="upload"
          title="A picture of surroundings, twice as wide as high (.hdr or .exr)"
          disabled={upload.value !== null}
          onClick={pickEnvironmentMap}
        >
          Picture from this computer
        </Button>
      </div>
      <ColorField
        label={environment.image ? "Tint" : "Color"}
        value={hex}
        onChange={(value, gesture) => edit([["/environment/color", joinScale(value, scale)]], gesture)}
      />
      <EnvironmentNumber of={environment} name="intensity" />
      <EnvironmentNumber of={environment} name="rotation_deg" disabled={!environment.image} />
      <Toggle
        label="Turns with the camera"
        value={environment.attached_to === "camera"}
        disabled={!environment.image}
        onChange={(on) => edit([["/environment/attached_to", on ? "camera" : "world"]])}
      />
      <Toggle
        label="Ambient"
        hint="Adds unshadowed light everywhere. Not physical."
        value={environment.ambient}
        onChange={(on) => edit([["/environment/ambient", on]])}
      />
    </>
  );
}

/** What is seen where the volume is not. */
export function BackgroundFields({ of }: { of: Scene }) {
  const background = of.background;
  if (!background) return null;
  return (
    <>
      <Segmented
        label="Show"
        value={background.kind}
        options={[
          { value: "color", label: "Color" },
          { value: "environment", label: "Picture", hint: "The environment" },
          { value: "transparent", label: "Nothing", hint: "The saved picture is transparent there" },
        ]}
        onChange={(kind) => edit([["/background/kind", kind]])}
      />
      {background.kind === "color" && (
        <ColorField
          label="Color"
          value={toHex(background.color)}
          onChange={(value, gesture) => edit([["/background/color", value]], gesture)}
        />
      )}
      {background.kind === "environment" && (
        <BackgroundNumber of={of.camera} name="background_blur_deg" />
      )}
    </>
  );
}
