import { useEffect, useState } from "preact/hooks";
import { edit, scene } from "../../state/scene";
import { hello } from "../../state/session";
import { volume } from "../../state/volume";

const kRetry_ms = 1500;
const kMostTries = 60;

/** A picture of this volume by a preset, as soon as there is one: the server draws them when it has time. */
function useThumbnail(name: string, of: string): string | null {
  const [url, setUrl] = useState<string | null>(null);
  useEffect(() => {
    let made: string | null = null;
    let timer: ReturnType<typeof setTimeout> | undefined;
    const stop = new AbortController();
    const ask = async (tries: number) => {
      try {
        const response = await fetch(`api/preset/${encodeURIComponent(name)}.png`, {
          signal: stop.signal,
          cache: "no-store",
        });
        if (response.ok) return setUrl((made = URL.createObjectURL(await response.blob())));
        if (response.status !== 503) return;
      } catch {
        if (stop.signal.aborted) return;
      }
      if (tries < kMostTries) timer = setTimeout(() => void ask(tries + 1), kRetry_ms);
    };
    void ask(1);
    return () => {
      stop.abort();
      clearTimeout(timer);
      if (made) URL.revokeObjectURL(made);
      setUrl(null);
    };
  }, [name, of]);
  return url;
}

/** Presets as pictures of this volume. */
export function Presets() {
  const chosen = scene.value?.transfer.preset;
  const presets = hello.value?.presets ?? [];
  return (
    <>
      <div class="presets" role="radiogroup" aria-label="Presets">
        {presets.map(({ name, summary }) => (
          <Preset key={name} name={name} summary={summary} chosen={name === chosen} />
        ))}
      </div>
      <p class="note">{presets.find((preset) => preset.name === chosen)?.summary}</p>
    </>
  );
}

function Preset({ name, summary, chosen }: { name: string; summary: string; chosen: boolean }) {
  const url = useThumbnail(name, volume.value?.name ?? "");
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
      <span class={url ? "thumbnail" : "thumbnail waiting"}>{url && <img src={url} alt="" />}</span>
      <span>{name}</span>
    </button>
  );
}
