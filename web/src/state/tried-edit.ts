import { on, onFrame } from "./connection";
import type { Assignment } from "./protocol";
import { edit, revision, undo } from "./scene";

/** Resolves once a picture shows what was edited last, to true, or once that cannot be drawn, to false. */
function followed(): Promise<boolean> {
  const before = revision.peek();
  return new Promise((resolve) => {
    const ends = [
      on("trouble", () => end(false)),
      on("refused", () => end(false)),
      onFrame((header) => header.revision > before && end(true)),
    ];
    const end = (is: boolean) => {
      for (const stop of ends) stop();
      resolve(is);
    };
  });
}

/** An edit that names a file, which may not be what it should: where it cannot be drawn, which the server tells, it is
 * taken back. Resolves to whether it could be. */
export async function tryEdit(set: readonly Assignment[]): Promise<boolean> {
  const unchanged = revision.peek();
  edit(set);
  if (await followed()) return true;
  // A refused edit has changed nothing, and later ones of others are theirs.
  if (revision.peek() === unchanged + 1) undo();
  return false;
}
