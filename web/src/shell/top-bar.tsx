import { canRedo, canUndo, redo, scene, undo } from "../state/scene";
import { volume } from "../state/volume";
import { IconButton } from "../ui/controls";

/** The bar on top: what is open, and what concerns the whole page. */
export function TopBar() {
  return (
    <header class="top-bar">
      <span class="brand">voxlume</span>
      <span class="open-name">{volume.value?.name}</span>
      <span class="spring" />
      <IconButton icon="undo" label="Undo" keys="Ctrl+Z" disabled={!scene.value || !canUndo.value} onClick={undo} />
      <IconButton icon="redo" label="Redo" keys="Ctrl+Shift+Z" disabled={!scene.value || !canRedo.value} onClick={redo} />
    </header>
  );
}
