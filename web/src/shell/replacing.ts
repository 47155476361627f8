import { on } from "../state/connection";
import { canUndo, loadScene, openPath, scene } from "../state/scene";
import type { Scene } from "../state/scene-types";
import { volume } from "../state/volume";
import { showToast } from "../ui/toast";

/** What takes the place of the open scene is told, with a way back: other volumes begin without steps to undo. */

/** The same text for scenes that are alike but for the picture's size, which is the page's. */
export function textOf(of: unknown): string {
  const { image, ...others } = of as { image?: Record<string, unknown> };
  const { width: _, height: __, ...rest } = image ?? {};
  return JSON.stringify({ ...others, image: rest }, (_key, value: unknown) =>
    typeof value === "object" && value !== null && !Array.isArray(value)
      ? Object.fromEntries(Object.entries(value).sort(([a], [b]) => (a < b ? -1 : 1)))
      : value,
  );
}

let endLast: () => void = () => undefined;

/** Calls `replace`, which asks for another scene, and `then` with the scenes before and after once that is there.
 * Not where none was open, both are alike, it cannot be had, or something else is asked for meanwhile. */
export function replacing(replace: () => void, then: (before: Scene, after: Scene) => void): void {
  endLast();
  const before = scene.peek();
  replace();
  if (!before) return;
  const ends = [
    on("scene", () => {
      end();
      const after = scene.peek()!;
      if (textOf(before) !== textOf(after)) then(before, after);
    }),
    on("status", (message) => (message.stage === "failed" || message.given_up) && end()),
    on("refused", () => end()),
  ];
  const end = (endLast = () => ends.forEach((stop) => stop()));
}

const fileOf = (path: string) => path.split("/").at(-1)!;

/** The scene that a notice has led back to, as textOf(): it has been edited, though it has no steps to undo. */
let restored = "";

/** Calls `replace`, which opens `name`, and offers the scene that was there where it had been edited. `isBack`: what
 * is opened has been edited, too. */
function openOver(name: string, replace: () => void, isBack = false): void {
  const isEdited = canUndo.peek() || (scene.peek() && textOf(scene.peek()) === restored);
  const from = volume.peek()?.name ?? "";
  replacing(replace, (before, after) => {
    if (isBack) restored = textOf(after);
    if (!isEdited) return;
    const isOther = before.volume.path !== after.volume.path;
    const back = () => openOver(from, () => loadScene(before), true);
    showToast({
      text: `Opened ${name}`,
      action: { label: isOther ? `Back to ${from}` : `Back to ${from} as it was`, run: back },
    });
  });
}

/** Opens a volume or scene file: a path of api/files, of an upload or of a sample. */
export function openFile(path: string): void {
  openOver(fileOf(path), () => openPath(path));
}

/** Loads the JSON of a scene file. */
export function loadSceneFile(name: string, json: unknown): void {
  openOver(name, () => loadScene(json));
}
