import { on } from "../state/connection";
import { canUndo, loadScene, revision, scene, undo } from "../state/scene";
import type { Scene } from "../state/scene-types";
import { viewers } from "../state/session";
import { showToast } from "../ui/toast";
import { decodeScene } from "./link";

/** A link may come from anybody, and what it leads to is what all pages of the viewer show: so it is told, and can be
 * taken back. */

/** The same text for scenes that are alike but for the picture's size, which is the page's. */
function textOf(of: unknown): string {
  const { image, ...others } = of as { image?: Record<string, unknown> };
  const { width: _, height: __, ...rest } = image ?? {};
  return JSON.stringify({ ...others, image: rest }, (_key, value: unknown) =>
    typeof value === "object" && value !== null && !Array.isArray(value)
      ? Object.fromEntries(Object.entries(value).sort(([a], [b]) => (a < b ? -1 : 1)))
      : value,
  );
}

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

/** Loads a scene and tells that it has taken the place of another one. */
function replaceBy(linked: unknown): void {
  const before = scene.peek();
  loadScene(linked);
  if (!before) return;
  const ends = [
    on("scene", () => {
      end();
      const after = scene.peek()!;
      if (textOf(before) !== textOf(after)) tell(before, after);
    }),
    on("status", (message) => message.stage === "failed" && end()),
    on("refused", () => end()),
  ];
  const end = () => ends.forEach((stop) => stop());
}

/** Opens the scene of the page's own address, once: reloading later keeps what has been changed since. */
export async function openLinkedScene(): Promise<void> {
  const { hash, pathname, search } = location;
  if (hash) history.replaceState(null, "", pathname + search);
  try {
    const linked = await decodeScene(hash);
    if (linked !== null && !(await isOpen(linked))) replaceBy(linked);
  } catch (error) {
    showToast({ tone: "error", text: (error as Error).message });
  }
}
