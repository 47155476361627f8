import { useEffect } from "preact/hooks";
import { drawPresets, drawnPresets, pictureTurn, presetPicture } from "../../state/preset-pictures";
import { edit, scene } from "../../state/scene";
import { hello } from "../../state/session";

/** Presets as pictures of this volume. */
export function Presets() {
  const chosen = scene.value?.transfer.preset;
  const presets = hello.value?.presets ?? [];
  useEffect(drawPresets, [pictureTurn.value]);
  return (
    <>
      <div class="presets" role="radiogroup" aria-label="Presets">
        {presets.map(({ name, summary }) => (
          <Preset key={name} name={name} summary={summary} chosen={name === chosen} />
        ))}
      </div>
      <p class="note">{presets.find((preset) => preset.name === chosen)?.summary ?? "The curve has been changed"}</p>
    </>
  );
}

function Preset({ name, summary, chosen }: { name: string; summary: string; chosen: boolean }) {
  const drawn = drawnPresets.value.has(name);
  const choose = () =>
    edit([
      ["/transfer/preset", name],
      ["/transfer/points", []],
    ]);
  return (
    <button
      type="button"
      role="radio"
      aria-checked={chosen}
      class="preset"
      title={`${name}: ${summary}`}
      onClick={choose}
    >
      <span class={drawn ? "thumbnail" : "thumbnail waiting"}>{drawn && <img src={presetPicture(name)} alt="" />}</span>
      <span>{name}</span>
    </button>
  );
}
