import { lengthScale } from "../state/lengths";
import { layout, resolution, theme, type Theme } from "../state/preferences";
import { canRedo, canUndo, redo, scene, undo } from "../state/scene";
import { warnings } from "../state/session";
import { volume, type VolumeFacts } from "../state/volume";
import { Button, IconButton } from "../ui/controls";
import { Icon } from "../ui/icons";
import { Menu } from "../ui/menu";
import { pickFiles } from "./files";
import { copyLink, saveExr, savePng, saveScene } from "./keep";
import { openDialog } from "./opening";
import { fullscreen, helpShown, toggleFullscreen, toggleSlices } from "./page-state";

function facts({ size, spacing_mm, type, modality, range }: VolumeFacts): string {
  const scale = lengthScale.value;
  return [
    `${size.join(" x ")} voxels`,
    `${spacing_mm.map((mm) => Number((mm / scale.mm).toPrecision(3))).join(" x ")} ${scale.unit}`,
    `${modality} ${type}, values ${range.map((x) => Number(x.toPrecision(5))).join(" to ")}`,
  ].join("\n");
}

function OpenVolume() {
  const open = volume.value;
  if (!open) return null;
  const warned = [...new Set([...open.warnings, ...warnings.value])];
  return (
    <span class="open-volume" title={facts(open)}>
      <span class="open-name">{open.name}</span>
      <span class="open-size">
        {open.size.join(" x ")}
        {open.modality && ` ${open.modality}`}
      </span>
      {warned.length > 0 && (
        <span class="open-warning" title={warned.join("\n")} role="img" aria-label={warned.join("; ")}>
          <Icon name="warning" />
        </span>
      )}
    </span>
  );
}

const resolutions = [
  { share: 1, label: "Full", hint: "One pixel for each of the view" },
  { share: 0.75, label: "Three quarters", hint: "About twice as fast" },
  { share: 0.5, label: "Half", hint: "Four times as fast" },
];
const themes: { value: Theme; label: string }[] = [
  { value: "system", label: "As the system" },
  { value: "dark", label: "Dark" },
  { value: "light", label: "Light" },
];

/** The bar on top: what is open, and what concerns the whole page. */
export function TopBar() {
  const none = !scene.value;
  return (
    <header class="top-bar">
      <h1 class="brand">
        <Icon name="volume" size={18} />
        voxlume
      </h1>
      <Button icon="folder" title="Open a volume or scene (Ctrl+O)" onClick={() => (openDialog.value = true)}>
        Open
      </Button>
      <OpenVolume />
      <span class="spring" />
      <IconButton
        icon="slices"
        label="Slices beside the picture"
        keys="S"
        pressed={layout.value === "slices"}
        disabled={none}
        onClick={toggleSlices}
      />
      <span class="divider" />
      <IconButton icon="undo" label="Undo" keys="Ctrl+Z" disabled={none || !canUndo.value} onClick={undo} />
      <IconButton icon="redo" label="Redo" keys="Ctrl+Shift+Z" disabled={none || !canRedo.value} onClick={redo} />
      <span class="divider" />
      <Menu
        label="Save the picture"
        icon="camera"
        disabled={none}
        items={[
          { label: "PNG", hint: "As on screen, at full size", icon: "download", run: savePng },
          { label: "EXR", hint: "Linear light, with metadata", icon: "download", run: saveExr },
        ]}
      />
      <Menu
        label="Scene file"
        icon="save"
        items={[
          { label: "Save scene", hint: "All settings, as JSON", icon: "download", disabled: none, run: saveScene },
          { label: "Load scene", hint: "From a file of this computer", icon: "upload", run: () => pickFiles(".json") },
        ]}
      />
      <IconButton
        icon="link"
        label="Copy a link to this scene"
        keys="Ctrl+Shift+L"
        disabled={none}
        onClick={copyLink}
      />
      <span class="divider" />
      <Menu
        label="Resolution and theme"
        icon="settings"
        items={[
          ...resolutions.map(({ share, label, hint }, i) => ({
            group: i === 0 ? "Resolution" : undefined,
            label,
            hint,
            checked: resolution.value === share,
            run: () => void (resolution.value = share),
          })),
          ...themes.map(({ value, label }, i) => ({
            group: i === 0 ? "Theme" : undefined,
            label,
            checked: theme.value === value,
            run: () => void (theme.value = value),
          })),
        ]}
      />
      <IconButton
        icon="fullscreen"
        label="Full screen"
        keys="Shift+F"
        pressed={fullscreen.value}
        onClick={toggleFullscreen}
      />
      <IconButton icon="help" label="Keys and gestures" keys="?" onClick={() => (helpShown.value = true)} />
    </header>
  );
}
