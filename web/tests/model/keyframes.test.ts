import { describe, expect, it } from "vitest";
import {
  byShortestWay,
  capture,
  deleteKeyframe,
  durationOf,
  emptyAnimation,
  frameCount,
  keyframesOf,
  moveKeyframe,
  orStill,
  turnsTwice,
  valuesAt,
  withoutCamera,
  withTracksOf,
} from "../../src/model/keyframes";

const two = capture(
  capture(undefined, 0, [
    ["/camera/zoom", 1],
    ["/camera/azimuth_deg", 0],
  ]),
  2,
  [["/camera/zoom", 3]],
);

describe("keyframes", () => {
  it("are the times at which any track has a key", () => {
    expect(keyframesOf(two)).toEqual([
      { time: 0, fields: ["/camera/zoom", "/camera/azimuth_deg"] },
      { time: 2, fields: ["/camera/zoom"] },
    ]);
  });

  it("replace keys that are there and stay sorted", () => {
    const again = capture(capture(two, 2.00001, [["/camera/zoom", 5]]), 1, [["/camera/zoom", 4]]);
    expect(again.tracks[0]!.keys).toEqual([
      [0, 1],
      [1, 4],
      [2.00001, 5],
    ]);
  });

  it("move with all their keys and push away what was there", () => {
    const moved = moveKeyframe(two, 0, 2);
    expect(moved.tracks).toEqual([
      { field: "/camera/zoom", interpolation: "smooth", keys: [[2, 1]] },
      { field: "/camera/azimuth_deg", interpolation: "smooth", keys: [[2, 0]] },
    ]);
    expect(moveKeyframe(two, 2, 0.5).tracks[0]!.keys.map(([t]) => t)).toEqual([0, 0.5]);
  });

  it("keep both keys of a jump", () => {
    const jump = {
      fps: 30,
      tracks: [
        {
          field: "/camera/zoom",
          interpolation: "linear" as const,
          keys: [
            [1, 2],
            [1, 3],
          ] as [number, number][],
        },
      ],
    };
    expect(moveKeyframe(jump, 1, 4).tracks[0]!.keys).toEqual([
      [4, 2],
      [4, 3],
    ]);
  });

  it("take tracks with them when they are the last", () => {
    expect(deleteKeyframe(two, 0).tracks.map((t) => t.field)).toEqual(["/camera/zoom"]);
    expect(orStill(deleteKeyframe(deleteKeyframe(two, 0), 2))).toBeNull();
    expect(orStill({ ...emptyAnimation, turntable: { seconds: 6, turns: 1 } })).not.toBeNull();
  });

  it("hold the values of all tracks that have a key there", () => {
    expect(valuesAt(two, 0)).toEqual([
      ["/camera/zoom", 1],
      ["/camera/azimuth_deg", 0],
    ]);
    expect(valuesAt(two, 2)).toEqual([["/camera/zoom", 3]]);
    expect(valuesAt(two, 1)).toEqual([]);
  });

  it("replace only the tracks of the same fields", () => {
    const written = withTracksOf(two, [{ field: "/camera/zoom", interpolation: "linear", keys: [[0, 9]] }]);
    expect(written.tracks.map((t) => t.field)).toEqual(["/camera/azimuth_deg", "/camera/zoom"]);
  });

  it("turn angles the shortest way", () => {
    const from = capture(undefined, 0, [["/camera/azimuth_deg", 170]]);
    expect(byShortestWay(from, 1, [["/camera/azimuth_deg", -170]])).toEqual([["/camera/azimuth_deg", 190]]);
    expect(byShortestWay(from, 1, [["/camera/zoom", -170]])).toEqual([["/camera/zoom", -170]]);
  });
});

describe("the number of frames", () => {
  it("is the one given, else the turntable's, else up to and with the last key", () => {
    expect(frameCount(two)).toBe(61);
    expect(frameCount({ ...two, turntable: { seconds: 3, turns: 2 } })).toBe(90);
    expect(frameCount({ ...two, frames: 7 })).toBe(7);
    expect(frameCount(undefined)).toBe(0);
    expect(frameCount(emptyAnimation)).toBe(0);
    expect(durationOf({ ...two, frames: 15 })).toBe(0.5);
  });
});

describe("a turntable beside keyframes of the camera", () => {
  const turntable = { seconds: 6, turns: 1 };
  const moving = capture(
    capture(undefined, 0, [
      ["/camera/azimuth_deg", 0],
      ["/lights/0/intensity", 1],
    ]),
    2,
    [["/camera/azimuth_deg", 90]],
  );

  it("turns twice where they turn, or go on after it", () => {
    expect(turnsTwice(undefined)).toBe(false);
    expect(turnsTwice(moving)).toBe(false);
    expect(turnsTwice({ ...moving, turntable })).toBe(true);
    expect(turnsTwice({ ...two, turntable })).toBe(false);
    expect(turnsTwice({ ...two, turntable: { seconds: 1, turns: 1 } })).toBe(true);
  });

  it("turns once without them; other keyframes stay", () => {
    const alone = withoutCamera({ ...moving, turntable });
    expect(turnsTwice(alone)).toBe(false);
    expect(alone.turntable).toEqual(turntable);
    expect(alone.tracks.map((track) => track.field)).toEqual(["/lights/0/intensity"]);
  });
});
