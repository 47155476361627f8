import { describe, expect, it } from "vitest";
import * as edits from "../src/state/edits";
import { valueAt, withValue } from "../src/state/pointer";

const start: edits.EditState<Record<string, unknown>> = {
  confirmed: {
    camera: { azimuth_deg: 0, zoom: 1 },
    lights: [{ intensity: 1 }, { intensity: 2 }],
    clip: { x_mm: [0, 1] },
  },
  pending: [],
};
const pending = (seq: number, pointer: string, value: unknown) => ({ seq, set: [[pointer, value]] as const });

describe("JSON pointers", () => {
  it("set, append and remove without touching the rest", () => {
    const before = start.confirmed;
    expect(valueAt(withValue(before, "/camera/zoom", 2), "/camera/zoom")).toBe(2);
    expect(withValue(before, "/camera/zoom", 2).lights).toBe(before.lights);
    expect(withValue(before, "/lights/-", { intensity: 3 }).lights).toHaveLength(3);
    expect(withValue(before, "/lights/0", null).lights).toEqual([{ intensity: 2 }]);
    expect("clip" in withValue(before, "/clip", null)).toBe(false);
    expect(before.lights).toHaveLength(2);
  });
  it("make the objects on their way", () => {
    expect(withValue({}, "/clip/x_mm", [1, 2])).toEqual({ clip: { x_mm: [1, 2] } });
    expect(withValue({}, "/lights/-", { intensity: 1 })).toEqual({ lights: [{ intensity: 1 }] });
  });
  it("unescape ~1 and ~0", () => {
    expect(valueAt({ "a/b~": 5 }, "/a~1b~0")).toBe(5);
  });
});

describe("edits on their way", () => {
  it("an answer to an older edit does not undo a newer one", () => {
    let state = { ...start, pending: [pending(1, "/camera/azimuth_deg", 10), pending(2, "/camera/azimuth_deg", 20)] };
    state = edits.edited(state, { camera: { azimuth_deg: 10, zoom: 1 } }, 1) as typeof state;
    expect(valueAt(edits.shown(state), "/camera/azimuth_deg")).toBe(20);
    state = edits.edited(state, { camera: { azimuth_deg: 20, zoom: 1 } }, 2) as typeof state;
    expect(state.pending).toHaveLength(0);
    expect(valueAt(edits.shown(state), "/camera/azimuth_deg")).toBe(20);
  });
  it("another page's edit of another field is kept below the own one", () => {
    let state = { ...start, pending: [pending(1, "/camera/azimuth_deg", 10)] };
    state = edits.edited(state, { camera: { azimuth_deg: 0, zoom: 3 } }) as typeof state;
    expect(edits.shown(state).camera).toEqual({ azimuth_deg: 10, zoom: 3 });
  });
  it("a refused edit shows the field as it was, later ones stay", () => {
    const state = { ...start, pending: [pending(1, "/camera/zoom", -1), pending(2, "/camera/azimuth_deg", 5)] };
    expect(edits.shown(edits.refused(state, 1)).camera).toEqual({ azimuth_deg: 5, zoom: 1 });
  });
  it("null is a section that is gone", () => {
    expect("clip" in edits.shown(edits.edited(start, { clip: null }))).toBe(false);
  });
});

describe("edits that become one message", () => {
  it("keep the last value of a field, and what is below an overwritten one is dropped", () => {
    expect(
      edits.merged(
        [
          ["/camera/zoom", 1],
          ["/clip/x_mm", [0, 1]],
        ],
        [
          ["/camera/zoom", 2],
          ["/clip", {}],
        ],
      ),
    ).toEqual([
      ["/camera/zoom", 2],
      ["/clip", {}],
    ]);
  });
  it("do not take in what changes the length of a list", () => {
    expect(edits.mergeable([["/lights/-", {}]])).toBe(false);
    expect(edits.mergeable([["/lights/0", null]])).toBe(false);
    expect(edits.mergeable([["/lights/0/intensity", 3]])).toBe(true);
  });
});
