import { canUndo, loadScene, revision, undo } from "../state/scene";
import type { Scene } from "../state/scene-types";
import { viewers } from "../state/session";
import { showToast } from "../ui/toast";
import { decodeScene } from "./link";
import { replacing, textOf } from "./replacing";

/** A link may come from anybody, and what it leads to is what all pages of the viewer show: so it is told, and can be
 * taken back. */

/** Whether the open scene is written as `linked` is. */
async function isOpen(linked: unknown): Promise<boolean> {
  const response = await fetch("api/scene.json");
  return response.ok && textOf(await response.json()) === textOf(linked);
}

function tell(before: Scene, after: Scene): void {
  const shownAt = revision.peek();
  const isOneStep = canUndo.peek() && before.volume.path === after.volume.path;
  const others = viewers.peek() > 1 ? `, for all ${viewers.peek()} pages of this viewer` : "";
  showToast({
    text: `The scene of the link has replaced what was shown${others}`,
    action: {
      label: "Undo",
      // What was changed since must not be taken for the link.
      run: () => (isOneStep && revision.peek() === shownAt ? undo() : loadScene(before)),
    },
  });
}

/** Opens the scene of the page's own address, once: reloading later keeps what has been changed since. */
export async function openLinkedScene(): Promise<void> {
  const { hash, pathname, search } = location;
  if (hash) history.replaceState(null, "", pathname + search);
  try {
    const linked = await decodeScene(hash);
    if (linked !== null && !(await isOpen(linked))) replacing(() => loadScene(linked), tell);
  } catch (error) {
    showToast({ tone: "error", text: (error as Error).message });
  }
}
