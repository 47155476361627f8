import { useEffect } from "preact/hooks";
import { toHex } from "../../color";
import { withTracksOf } from "../../model/keyframes";
import { flashTrack, orbitTrack } from "../../model/light-motion";
import { edit, scene } from "../../state/scene";
import type { Light, Scene, Vec3 } from "../../state/scene-types";
import { lightHandles, selectedLight } from "../../state/tools";
import { Button, IconButton, Section, Slider, Toggle } from "../../ui/controls";
import { showToast } from "../../ui/toast";
import { BackgroundFields, EnvironmentFields } from "./environment";
import { LightFields } from "./light-fields";
import { moving, period, startMotion, stopMotion, type Motion } from "./motion";

const kindNames: Record<Light["kind"], string> = { directional: "Directional", point: "Point", rect: "Area" };

/** A light that is seen at once, whatever the size of the volume. */
function newLight(kind: Light["kind"], of: Scene): Light {
  const radius = of.camera.fit_radius_mm ?? 150;
  const target = of.camera.target_mm ?? [0, 0, 0];
  const position: Vec3 = [target[0] - 1.5 * radius, target[1] - 1.8 * radius, target[2] + 1.2 * radius];
  const base = {
    kind,
    attached_to: "world" as const,
    color: "#ffffff",
    size_mm: [radius, radius] as const,
    two_sided: false,
  };
  if (kind === "directional") return { ...base, intensity: 3, direction: [-0.5, -0.6, 0.6] };
  if (kind === "point") return { ...base, intensity: Number((20 * radius ** 2).toPrecision(2)), position_mm: position };
  return { ...base, intensity: 25, position_mm: position };
}

export function LightsPanel() {
  const of = scene.value;
  useEffect(() => {
    lightHandles.value = true;
    return () => {
      lightHandles.value = false;
    };
  }, []);
  if (!of) return null;
  return (
    <>
      <LightList of={of} />
      <Section title="Environment">
        <EnvironmentFields of={of} />
      </Section>
      <Section title="Background">
        <BackgroundFields of={of} />
      </Section>
    </>
  );
}

function LightList({ of }: { of: Scene }) {
  const lights = of.lights ?? [];
  const index =
    selectedLight.value !== null && lights[selectedLight.value] ? selectedLight.value : lights.length ? 0 : null;
  const light = index === null ? undefined : lights[index];
  const append = (added: Light) => {
    edit([["/lights/-", added]]);
    selectedLight.value = lights.length;
  };
  const duplicate = () => {
    stopMotion();
    append(scene.peek()!.lights![index!]!);
  };
  const remove = () => {
    stopMotion();
    edit([[`/lights/${index}`, null]]);
    selectedLight.value = lights.length > 1 ? Math.max(0, index! - 1) : null;
  };
  const actions = light && (
    <>
      <IconButton icon="copy" label="Duplicate the light" onClick={duplicate} />
      <IconButton icon="delete" label="Remove the light" onClick={remove} />
    </>
  );
  return (
    <Section title="Lights" actions={actions}>
      <div class="light-list" role="radiogroup" aria-label="Lights">
        {lights.map((one, i) => (
          <button
            key={i}
            type="button"
            role="radio"
            aria-checked={i === index}
            onClick={() => (selectedLight.value = i)}
          >
            <span class="swatch" style={{ background: toHex(one.color), opacity: one.intensity > 0 ? 1 : 0.25 }} />
            <span>
              {kindNames[one.kind]} {i + 1}
            </span>
            <small>{one.attached_to === "camera" ? "on the camera" : ""}</small>
          </button>
        ))}
      </div>
      <div class="row-actions">
        {(["rect", "point", "directional"] as const).map((kind) => (
          <Button key={kind} icon="add" onClick={() => append(newLight(kind, of))}>
            {kindNames[kind]}
          </Button>
        ))}
      </div>
      {light && index !== null && (
        <>
          <LightFields key={index} light={light} index={index} />
          <MotionFields of={of} index={index} />
        </>
      )}
    </Section>
  );
}

/** Motion by itself: rotate and flash. */
function MotionFields({ of, index }: { of: Scene; index: number }) {
  const now = moving.value?.light === index ? moving.value.motion : null;
  const toggle = (motion: Motion) => (on: boolean) => (on ? void startMotion(motion, index) : stopMotion());
  const write = (motion: Motion) => {
    const target = of.camera.target_mm ?? [0, 0, 0];
    stopMotion();
    const light = scene.peek()!.lights![index]!;
    const track =
      motion === "orbit" ? orbitTrack(light, index, target, period.value) : flashTrack(light, index, period.value);
    edit([["/animation", withTracksOf(of.animation, [track])]]);
    showToast({ text: `The motion is in the animation: ${period.value} s` });
  };
  return (
    <div class="panel-card motion">
      <Toggle
        label="Rotate"
        hint="The light goes around the point that the camera turns about"
        value={now === "orbit"}
        onChange={toggle("orbit")}
      />
      <Toggle
        label="Flash"
        hint="The light is seen dim and bright in turn; the scene keeps its intensity"
        value={now === "flash"}
        onChange={toggle("flash")}
      />
      <Slider
        label="Period"
        unit="s"
        min={1}
        max={30}
        step={0.5}
        digits={1}
        value={period.value}
        onChange={(value) => (period.value = value)}
      />
      <div class="row-actions">
        <Button icon="film" title="Writes a turn as tracks of the animation" onClick={() => write("orbit")}>
          Keep the turn
        </Button>
        <Button icon="film" title="Writes a flash as a track of the animation" onClick={() => write("flash")}>
          Keep the flash
        </Button>
      </div>
    </div>
  );
}
