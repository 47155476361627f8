import { withValue } from "./pointer";
import type { Assignment } from "./protocol";

/** What the page shows while its edits are on their way: the server's last word with the edits on top that it has not
 * answered. Pure; state/scene.ts has the one that counts. */

export interface PendingEdit {
  seq: number;
  set: readonly Assignment[];
  gesture?: string;
}

export interface EditState<S> {
  confirmed: S;
  pending: readonly PendingEdit[];
}

/** The confirmed state with all pending edits applied in order. */
export function shown<S>(state: EditState<S>): S {
  return state.pending.reduce((scene, edit) => applied(scene, edit.set), state.confirmed);
}

export function applied<S>(scene: S, set: readonly Assignment[]): S {
  return set.reduce((at, [pointer, value]) => withValue(at, pointer, value), scene);
}

/** The server changed `sections` (null: gone), in answer to the edit `seq` and those before it, or by another page. */
export function edited<S>(state: EditState<S>, sections: Record<string, unknown>, seq?: number): EditState<S> {
  const confirmed = { ...state.confirmed } as Record<string, unknown>;
  for (const [name, value] of Object.entries(sections)) {
    if (value === null) delete confirmed[name];
    else confirmed[name] = value;
  }
  const pending = seq === undefined ? state.pending : state.pending.filter((edit) => edit.seq > seq);
  return { confirmed: confirmed as S, pending };
}

/** The server did not take the edit `seq`. */
export function refused<S>(state: EditState<S>, seq: number): EditState<S> {
  return { ...state, pending: state.pending.filter((edit) => edit.seq !== seq) };
}

/** Whether the assignments may wait and be sent as one with later ones: what changes the length of a list may not. */
export function mergeable(set: readonly Assignment[]): boolean {
  return set.every(([pointer, value]) => value !== null && !pointer.endsWith("/-"));
}

/** One list that does what `first` and then `second` do, without what `second` overwrites. Both mergeable(). */
export function merged(first: readonly Assignment[], second: readonly Assignment[]): Assignment[] {
  const overwritten = (pointer: string) =>
    second.some(([newer]) => pointer === newer || pointer.startsWith(`${newer}/`));
  return [...first.filter(([pointer]) => !overwritten(pointer)), ...second];
}
