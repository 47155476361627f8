import { useEffect, useState } from "preact/hooks";
import { hello } from "../state/session";
import { getJson } from "../state/volume";
import { Icon, type IconName } from "../ui/icons";
import { openFile } from "./replacing";

interface Entry {
  name: string;
  path: string;
  kind: "folder" | "volume" | "scene" | "environment" | "other";
  bytes: number;
}

const icons: Record<Entry["kind"], IconName> = {
  folder: "folder",
  volume: "volume",
  scene: "layers",
  environment: "sun",
  other: "file",
};

export function formatBytes(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  const [size, unit] = bytes < 1e6 ? [bytes / 1e3, "kB"] : bytes < 1e9 ? [bytes / 1e6, "MB"] : [bytes / 1e9, "GB"];
  return `${size < 10 ? size.toFixed(1) : Math.round(size)} ${unit}`;
}

/** Names that slices of a series have: DICOM often without an extension, or a number for one; TIFF. */
const kSlice = /(^[^.]+|\.(\d+|dcm|dicom|ima|tiff?))$/i;

/** The files below the folder the viewer was started with; those of `kinds` (volumes and scenes) can be chosen, which
 * opens them unless `onChoose` is given, and folders entered. */
export function FileBrowser({
  onOpen,
  onChoose = openFile,
  kinds = ["volume", "scene"],
}: {
  onOpen?(): void;
  onChoose?(path: string): void;
  kinds?: readonly Entry["kind"][];
}) {
  const [path, setPath] = useState("");
  const [entries, setEntries] = useState<Entry[] | null>(null);
  const [failure, setFailure] = useState("");
  useEffect(() => {
    let current = true;
    setEntries(null);
    setFailure("");
    getJson<{ entries: Entry[] }>(`api/files?path=${encodeURIComponent(path)}`)
      .then((answer) => current && setEntries(answer.entries))
      .catch((error: Error) => current && setFailure(error.message));
    return () => {
      current = false;
    };
  }, [path]);
  const parts = path.split("/").filter(Boolean);
  const take = (chosen: string) => {
    onChoose(chosen);
    onOpen?.();
  };
  const choose = (entry: Entry) => (entry.kind === "folder" ? setPath(entry.path) : take(entry.path));
  const slices = entries?.filter((entry) => entry.kind !== "folder" && kSlice.test(entry.name)).length ?? 0;
  const order = (entry: Entry) => (entry.kind === "folder" ? 0 : kinds.includes(entry.kind) ? 1 : 2);
  const sorted = entries
    ?.slice()
    .sort((a, b) => order(a) - order(b) || a.name.localeCompare(b.name, undefined, { numeric: true }));
  return (
    <div class="files">
      <nav class="crumbs" aria-label="Folder">
        <button type="button" onClick={() => setPath("")}>
          {hello.value?.folder.split("/").pop() || "Files"}
        </button>
        {parts.map((part, i) => (
          <>
            <Icon name="chevron" size={12} />
            <button type="button" onClick={() => setPath(parts.slice(0, i + 1).join("/"))}>
              {part}
            </button>
          </>
        ))}
        {slices > 1 && (
          <>
            <span class="spring" />
            <button type="button" title="The files of this folder as the slices of one volume" onClick={() => take(path)}>
              Open {slices} slices
            </button>
          </>
        )}
      </nav>
      <div class="entries">
        {failure && <p class="failure">{failure}</p>}
        {sorted?.length === 0 && <p class="empty">This folder is empty.</p>}
        {sorted?.map((entry) => (
          <button
            key={entry.path}
            type="button"
            class={`entry ${entry.kind}`}
            disabled={order(entry) === 2}
            onClick={() => choose(entry)}
          >
            <Icon name={icons[entry.kind]} />
            <span class="entry-name">{entry.name}</span>
            {entry.kind !== "folder" && <span class="entry-size">{formatBytes(entry.bytes)}</span>}
          </button>
        ))}
      </div>
    </div>
  );
}
