import { batch, computed, signal, type ReadonlySignal } from "@preact/signals";
import { link, on, send } from "./connection";
import * as edits from "./edits";
import { valueAt } from "./pointer";
import type { Assignment } from "./protocol";
import type { Scene } from "./scene-types";

/** The scene as this page shows it, and all ways to change it. */

const state = signal<edits.EditState<Scene> | null>(null);
const undoable = signal({ undo: false, redo: false });

/** The scene with this page's own edits in it, answered or not; null while none is open. Sections that an edit does
 * not touch keep their identity. */
export const scene: ReadonlySignal<Scene | null> = computed(() => (state.value ? edits.shown(state.value) : null));

export const canUndo: ReadonlySignal<boolean> = computed(() => undoable.value.undo);
export const canRedo: ReadonlySignal<boolean> = computed(() => undoable.value.redo);

/** The newest edit that the server has told of; frames up to it show it. */
export const revision = signal(0);

/** The last refusal: the field's JSON pointer and why. */
export const refusal = signal<{ where: string; message: string } | null>(null);

/** A section of the scene as a signal of its own, which changes only with it: `section("camera")`. */
export function section<K extends keyof Scene>(name: K): ReadonlySignal<Scene[K] | undefined> {
  return computed(() => scene.value?.[name]);
}

/** What is at a JSON pointer of the scene, or `otherwise`. */
export function field<T>(pointer: string, otherwise: T): T {
  return (valueAt(scene.value, pointer) as T | undefined) ?? otherwise;
}

const page = Math.random().toString(36).slice(2, 6);
let gestures = 0;

/** A name for the edits of one drag, which are one step of undo: call it when the drag starts. */
export function newGesture(what: string): string {
  return `${what}-${page}-${++gestures}`;
}

let lastSeq = 0;
let queued: edits.PendingEdit | null = null;
let timer: ReturnType<typeof setTimeout> | undefined;
let sentAt_ms = 0;
/** At most about 100 messages a second: one per animation frame of most screens, half of what the server takes. */
const kInterval_ms = 10;

/** Sends what waits to be sent as one with later edits: before the page goes. */
export function flushEdits(): void {
  clearTimeout(timer);
  timer = undefined;
  if (!queued) return;
  const { seq, set, gesture } = queued;
  queued = null;
  sentAt_ms = performance.now();
  send({ type: "edit", seq, set, ...(gesture ? { gesture } : {}) });
}

function flushSoon(): void {
  if (timer !== undefined) return;
  const wait_ms = Math.max(0, kInterval_ms - (performance.now() - sentAt_ms));
  if (wait_ms <= 0) flushEdits();
  else timer = setTimeout(flushEdits, wait_ms);
}

/** Sets fields of the scene by JSON pointer, null removes: shown at once, sent, and taken back if the server refuses.
 * Edits of one `gesture` (newGesture) are one step of undo, and those that come faster than they can be sent become
 * one message. Does nothing while no scene is open or the connection is lost. */
export function edit(set: readonly Assignment[], gesture?: string): void {
  if (!state.value || link.value.kind !== "open" || set.length === 0) return;
  const before = state.value;
  if (queued && gesture && queued.gesture === gesture && edits.mergeable(queued.set) && edits.mergeable(set)) {
    queued = { ...queued, set: edits.merged(queued.set, set) };
    state.value = { ...before, pending: [...before.pending.slice(0, -1), queued] };
  } else {
    flushEdits();
    queued = { seq: ++lastSeq, set, gesture };
    state.value = { ...before, pending: [...before.pending, queued] };
  }
  if (gesture) flushSoon();
  else flushEdits();
}

/** Of what was shown in passing and is not answered yet. */
const passing = new Set<number>();

/** Shows the scene with other values of these fields, without changing it, until something else is shown in passing;
 * an empty list: as it is. */
export function showPassing(set: readonly Assignment[]): void {
  if (!state.value) return;
  flushEdits();
  const seq = ++lastSeq;
  if (send({ type: "passing", seq, set })) passing.add(seq);
}

export function undo(): void {
  flushEdits();
  send({ type: "undo" });
}

export function redo(): void {
  flushEdits();
  send({ type: "redo" });
}

/** Another scene in place of this one: a whole scene file's JSON. */
export function loadScene(other: unknown): void {
  flushEdits();
  send({ type: "load", scene: other });
}

/** Opens a volume or scene file: a path of api/files, of an upload or of a sample. */
export function openPath(path: string): void {
  flushEdits();
  send({ type: "open", path });
}

on("hello", () => {
  // All is told anew, and what was not answered before the connection was lost may not have arrived.
  queued = null;
  passing.clear();
  if (state.value) state.value = { ...state.value, pending: [] };
});

on("scene", (message) =>
  batch(() => {
    state.value = { confirmed: message.scene, pending: state.value?.pending ?? [] };
    undoable.value = { undo: message.can_undo, redo: message.can_redo };
    revision.value = message.revision;
  }),
);

on("edited", (message) =>
  batch(() => {
    if (message.seq !== undefined) passing.delete(message.seq);
    if (state.value) state.value = edits.edited(state.value, message.sections, message.seq);
    undoable.value = { undo: message.can_undo, redo: message.can_redo };
    revision.value = message.revision;
  }),
);

on("refused", (message) =>
  batch(() => {
    // Somebody else has changed the scene in the meantime; nothing of it is lost.
    if (passing.delete(message.seq)) return;
    if (state.value) state.value = edits.refused(state.value, message.seq);
    refusal.value = { where: message.where, message: message.message };
  }),
);

on("status", (message) => {
  if (message.stage === "empty") state.value = null;
});
