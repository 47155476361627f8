import { on, onFrame } from "./connection";
import type { Assignment } from "./protocol";
import { edit, undo } from "./scene";

/** An edit that names a file, which may not be what it should: where it cannot be drawn, which the server tells, it is
 * taken back. Resolves to whether it could be. */
export function tryEdit(set: readonly Assignment[]): Promise<boolean> {
  /** Edits that count as steps of undo; the picture's size is the page's and does not. */
  let steps = 0;
  /** The first revision with it. */
  let since = Infinity;
  return new Promise((resolve) => {
    const ends = [
      on("edited", ({ sections, revision }) => {
        if (!Object.keys(sections).some((name) => name !== "image")) return;
        ++steps;
        since = Math.min(since, revision);
      }),
      on("scene", () => (steps = Infinity)),
      on("trouble", () => end(false)),
      on("refused", () => end(false)),
      onFrame((header) => header.revision >= since && end(true)),
    ];
    const end = (is: boolean) => {
      for (const stop of ends) stop();
      // A refused edit has changed nothing, and later ones of others are theirs.
      if (!is && steps === 1) undo();
      resolve(is);
    };
    edit(set);
  });
}
