import { describe, expect, it } from "vitest";
import { distance } from "../../src/geometry/vec3";
import {
  canvasOf,
  commonScale,
  mostZoom,
  pannedFraming,
  planeNames,
  planes,
  pointOf,
  slicePlace,
  zoomedFraming,
  type Framing,
  type PaneView,
  type SliceHeader,
} from "../../src/model/slice";
import { automaticWindow, decode, dragWindow, greyTable } from "../../src/model/window";
import type { Vec3 } from "../../src/state/scene-types";

const header: SliceHeader = { width: 100, height: 50, origin_mm: [-99, -40], spacing_mm: 2, scale: 0.5, offset: -1024 };
/** Unit steps of LPS by the letter that they lead to. */
const toward: Record<string, Vec3> = {
  L: [1, 0, 0],
  R: [-1, 0, 0],
  P: [0, 1, 0],
  A: [0, -1, 0],
  S: [0, 0, 1],
  I: [0, 0, -1],
};
const pane: PaneView = { width: 400, height: 300, center_mm: [5, -6, 7], pxPerMm: 3 };

describe("slices on the screen", () => {
  it.each(planeNames)("the %s plane has the patient's sides where its letters say", (name) => {
    const layout = planes[name];
    const at = (p: Vec3) => canvasOf(layout, pane, p);
    const middle = at([0, 0, 0]);
    const step = (letter: string) => at(toward[letter]!).map((x, i) => x - middle[i]!);
    expect(step(layout.letters.left)[0]).toBeLessThan(0);
    expect(step(layout.letters.right)[0]).toBeGreaterThan(0);
    expect(step(layout.letters.top)[1]).toBeLessThan(0);
    expect(step(layout.letters.bottom)[1]).toBeGreaterThan(0);
  });

  it("shows the patient's right on the left", () => {
    expect(planes.axial.letters.left).toBe("R");
    expect(planes.coronal.letters.left).toBe("R");
  });

  it.each(planeNames)("the %s plane's places and points are each other's inverse", (name) => {
    const layout = planes[name];
    const p: [number, number, number] = [12, -7, 3];
    const [x, y] = canvasOf(layout, pane, p);
    const back = pointOf(layout, pane, p[layout.normal], x, y);
    back.forEach((value, i) => expect(value).toBeCloseTo(p[i]!));
  });

  it.each(planeNames)("the %s plane's samples lie where their points are", (name) => {
    const layout = planes[name];
    const { left, top, width, height } = slicePlace(layout, header, pane);
    expect([width, height]).toEqual([600, 300]);
    // The first sample's centre, half a sample from the corner; rows toward the head go up.
    const first: [number, number, number] = [0, 0, 0];
    first[layout.across] = -99;
    first[layout.along] = -40;
    const [x, y] = canvasOf(layout, pane, first);
    expect(x).toBeCloseTo(left + 3);
    expect(y).toBeCloseTo(layout.flipped ? top + height - 3 : top + 3);
  });
});

describe("what the panes show", () => {
  const bounds: [Vec3, Vec3] = [
    [-100, -50, 0],
    [100, 50, 300],
  ];
  const framing: Framing = { center_mm: [0, 0, 150], zoom: 1 };

  it("has one scale, at which every whole plane has room in its pane", () => {
    const same = { width: 400, height: 300 };
    // Coronal and sagittal need 300 mm in 300 px, the axial plane would have room at 2 px a mm.
    expect(commonScale(bounds, { axial: same, coronal: same, sagittal: same })).toBe(1);
    expect(commonScale(bounds, { axial: same })).toBe(2);
    expect(commonScale(bounds, { axial: same, coronal: { width: 100, height: 300 }, sagittal: same })).toBe(0.5);
  });

  it("is zoomed about the point under the pointer", () => {
    const about: Vec3 = [30, -20, 40];
    const near = zoomedFraming(framing, 4, about)!;
    for (const name of planeNames) {
      const seen = ({ center_mm, zoom }: Framing) => canvasOf(planes[name], { ...pane, center_mm, pxPerMm: zoom }, about);
      seen(near).forEach((x, i) => expect(x).toBeCloseTo(seen(framing)[i]!));
    }
    expect(near.zoom).toBe(4);
    expect(zoomedFraming(near, 1e6, about)!.zoom).toBe(mostZoom);
    expect(zoomedFraming(near, 0.2, about)).toBeNull();
  });

  it.each(planeNames)("follows a drag in the %s plane", (name) => {
    const layout = planes[name];
    const p: Vec3 = [3, 4, 155];
    const seen = ({ center_mm }: Framing) => canvasOf(layout, { ...pane, center_mm }, p);
    const moved = pannedFraming(framing, layout, pane.pxPerMm, [12, -9], bounds);
    const [before, after] = [seen(framing), seen(moved)];
    expect(after[0] - before[0]).toBeCloseTo(12);
    expect(after[1] - before[1]).toBeCloseTo(-9);
    expect(moved.center_mm[layout.normal]).toBe(framing.center_mm[layout.normal]);
  });

  it("keeps its middle in the volume", () => {
    const { center_mm } = pannedFraming(framing, planes.axial, 1, [-1e5, 1e5], bounds);
    expect(distance(center_mm, [100, -50, 150])).toBe(0);
  });
});

describe("window and level", () => {
  it("maps black and white to the ends of the window", () => {
    const table = greyTable(header, { level: 40, width: 80 });
    const code = (value: number) => (value - header.offset) / header.scale + 1;
    expect(table[code(0)]).toBe(0);
    expect(table[code(40)]).toBe(128);
    expect(table[code(80)]).toBe(255);
    expect(table[code(2000)]).toBe(255);
    expect(table[0]).toBe(0);
    expect(decode(header, code(40))).toBe(40);
    expect(decode(header, 0)).toBeUndefined();
  });

  it("widens to the right and brightens upward", () => {
    const from = { level: 100, width: 250 };
    expect(dragWindow(from, 10, 0, 1000)).toEqual({ level: 100, width: 260 });
    expect(dragWindow(from, 0, 10, 1000).level).toBe(110);
    expect(dragWindow(from, -1e6, 0, 1000).width).toBeGreaterThan(0);
  });

  /** What the server tells of a volume with that many voxels of each value 0, 1, 2, ... */
  const factsOf = (counts: readonly number[]) => {
    const all = counts.reduce((sum, n) => sum + n, 0);
    const percentile = (p: number) => {
      let below = 0;
      return counts.findIndex((n) => (below += n) >= (p / 100) * all);
    };
    const percentiles = Object.fromEntries([0.1, 1, 5, 50, 95, 99, 99.9].map((p) => [String(p), percentile(p)]));
    const hi = counts.length - 1;
    return { range: [0, hi] as const, percentiles, histogram: { lo: 0, hi, counts } };
  };
  const peak = (middle: number, width: number, count: number) => (value: number) =>
    Math.round((count / (width * 2.507)) * Math.exp(-0.5 * ((value - middle) / width) ** 2));
  const valuesOf = (length: number, ...peaks: ((value: number) => number)[]) =>
    Array.from({ length }, (_, value) => peaks.reduce((sum, of) => sum + of(value), 0));
  const shade = (counts: readonly number[], value: number) => {
    const { level, width } = automaticWindow(factsOf(counts));
    return (value - level) / width + 0.5;
  };

  it("starts with the brightest tissue below white, however large the background is", () => {
    for (const background of [0, 1e5, 1e6, 1e7]) {
      const counts = valuesOf(200, (v) => (v === 0 ? background : 0), peak(80, 8, 1e5), peak(115, 3, 8e4));
      expect(shade(counts, 115)).toBeGreaterThan(0.8);
      expect(shade(counts, 120)).toBeLessThan(0.96);
    }
    // Where fat is brighter than what is looked at.
    expect(shade(valuesOf(256, peak(3, 2, 4e5), peak(80, 10, 3e5), peak(113, 5, 2e5), peak(180, 20, 3e4)), 113)).toBeGreaterThan(0.5);
  });

  it("starts with what is sparse in sight, above the noise of a camera", () => {
    const counts = valuesOf(4096, peak(100, 10, 1e7), peak(1500, 300, 4e4));
    expect(shade(counts, 1500)).toBeGreaterThan(0.5);
    expect(shade(counts, 1500)).toBeLessThan(0.95);
    expect(shade(counts, 130)).toBeLessThan(0.05);
  });

  it("starts with all values where there is no more to go by", () => {
    expect(automaticWindow(factsOf([5]))).toEqual({ level: 0, width: 1e-6 });
    expect(automaticWindow(factsOf([7, 3]))).toEqual({ level: 0.5, width: 1 });
    // One value far out has all others in one bin.
    const outlier = { range: [0, 1e32], percentiles: { "0.1": 0, "1": 1, "99": 101, "99.9": 110 }, histogram: { lo: 0, hi: 1e32, counts: [1e6, ...Array(510).fill(0), 1] } } as const;
    expect(automaticWindow(outlier)).toEqual({ level: 56, width: 110 });
  });
});
