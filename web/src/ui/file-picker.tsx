import { useEffect, useState } from "preact/hooks";
import { getJson } from "../state/volume";
import { IconButton } from "./controls";
import { Dialog } from "./dialog";
import { Icon, type IconName } from "./icons";

type Kind = "folder" | "volume" | "scene" | "environment" | "other";

interface Entry {
  name: string;
  path: string;
  kind: Kind;
  bytes: number;
}

const icons: Record<Kind, IconName> = { folder: "folder", volume: "volume", scene: "film", environment: "light", other: "box" };

function formatBytes(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  const [size, unit] = bytes < 1e6 ? [bytes / 1e3, "kB"] : bytes < 1e9 ? [bytes / 1e6, "MB"] : [bytes / 1e9, "GB"];
  return `${size < 10 ? size.toFixed(1) : Math.round(size)} ${unit}`;
}

/** Chooses a file of the server's folder: folders are opened, files of other kinds than `kinds` are not shown. */
export function FilePicker(props: {
  title: string;
  kinds: readonly Exclude<Kind, "folder">[];
  onPick(path: string): void;
  onClose(): void;
}) {
  const [path, setPath] = useState("");
  const [entries, setEntries] = useState<readonly Entry[] | null>(null);
  const [failure, setFailure] = useState("");
  useEffect(() => {
    let wanted = true;
    setEntries(null);
    setFailure("");
    getJson<{ entries: Entry[] }>(`api/files?path=${encodeURIComponent(path)}`)
      .then((answer) => wanted && setEntries(answer.entries))
      .catch((error: Error) => wanted && setFailure(error.message));
    return () => void (wanted = false);
  }, [path]);
  const shown = entries?.filter((entry) => entry.kind === "folder" || (props.kinds as Kind[]).includes(entry.kind));
  return (
    <Dialog title={props.title} onClose={props.onClose}>
      <div class="file-path">
        <IconButton icon="undo" label="Up" disabled={!path} onClick={() => setPath(path.split("/").slice(0, -1).join("/"))} />
        <span>{path || "The viewer's folder"}</span>
      </div>
      <ul class="file-list">
        {shown?.map((entry) => (
          <li key={entry.path}>
            <button type="button" onClick={() => (entry.kind === "folder" ? setPath(entry.path) : props.onPick(entry.path))}>
              <Icon name={icons[entry.kind]} />
              <span>{entry.name}</span>
              {entry.kind !== "folder" && <small>{formatBytes(entry.bytes)}</small>}
            </button>
          </li>
        ))}
      </ul>
      {shown?.length === 0 && <p class="note">Nothing here that can be used.</p>}
      {failure && <p class="note warning">{failure}</p>}
    </Dialog>
  );
}
