import { useEffect } from "preact/hooks";
import type { Axis } from "../geometry/orientation";
import { edit, newGesture, scene } from "../state/scene";
import type { Clip } from "../state/scene-types";
import { clipHandles } from "../state/tools";
import { volume } from "../state/volume";
import { Button, Section, Slider, Toggle } from "../ui/controls";

/** Axes with the words for their two ends: LPS grows toward left, posterior and superior. */
const axes = [
  { key: "x_mm", lower: "Right", upper: "Left" },
  { key: "y_mm", lower: "Anterior", upper: "Posterior" },
  { key: "z_mm", lower: "Inferior", upper: "Superior" },
] as const;

/** The box keeps at least this. */
const kThinnest_voxels = 0.01;

/** The box before it was switched off. */
let remembered: Clip | null = null;

/** A box outside of which nothing is seen. */
export function ClipPanel() {
  const of = scene.value;
  const facts = volume.value;
  useEffect(() => {
    clipHandles.value = true;
    return () => {
      clipHandles.value = false;
    };
  }, []);
  if (!of || !facts) return null;
  const bounds = facts.bounds_mm;
  const { clip } = of;
  const whole = (blocks_light: boolean): Clip => ({
    x_mm: [bounds[0][0], bounds[1][0]],
    y_mm: [bounds[0][1], bounds[1][1]],
    z_mm: [bounds[0][2], bounds[1][2]],
    blocks_light,
  });
  const toggle = (on: boolean) => {
    if (clip) remembered = clip;
    edit([["/clip", on ? (remembered ?? whole(false)) : null]], newGesture("clip"));
  };
  const set = (key: (typeof axes)[number]["key"], end: 0 | 1, value: number, gesture: string) => {
    const other = (clip ?? whole(false))[key][1 - end]!;
    const thin_mm = kThinnest_voxels * Math.min(...facts.spacing_mm);
    const kept = other === null ? value : end === 0 ? Math.min(value, other - thin_mm) : Math.max(value, other + thin_mm);
    edit([[`/clip/${key}`, end === 0 ? [kept, other] : [other, kept]]], gesture);
  };
  return (
    <Section title="Clip box">
      <Toggle label="Cut the volume" value={clip !== undefined} onChange={toggle} />
      {axes.map(({ key, lower, upper }, axis) => {
        const lo = bounds[0][axis]!;
        const hi = bounds[1][axis]!;
        return ([0, 1] as const).map((end) => (
          <Slider
            key={`${key}${end}`}
            label={end === 0 ? lower : upper}
            unit="mm"
            axis={axis as Axis}
            min={lo}
            max={hi}
            hardMin={-1e12}
            hardMax={1e12}
            initial={end === 0 ? lo : hi}
            disabled={!clip}
            value={Math.min(Math.max(clip?.[key][end] ?? [lo, hi][end]!, lo), hi)}
            onChange={(value, gesture) => set(key, end, value, gesture)}
          />
        ));
      })}
      <Toggle
        label="What is cut still casts shadows"
        value={clip?.blocks_light ?? false}
        disabled={!clip}
        onChange={(on) => edit([["/clip/blocks_light", on]])}
      />
      <Toggle
        label="Handles in the picture"
        value={clipHandles.value}
        disabled={!clip}
        onChange={(on) => (clipHandles.value = on)}
      />
      <div class="row-actions">
        <Button
          icon="reset"
          disabled={!clip}
          onClick={() => edit([["/clip", whole(clip?.blocks_light ?? false)]], newGesture("clip"))}
        >
          Whole volume
        </Button>
      </div>
    </Section>
  );
}
