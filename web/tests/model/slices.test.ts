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
import { decode, dragWindow, greyTable, percentileWindow } from "../../src/model/window";
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

  it("starts with nearly all values in sight", () => {
    expect(percentileWindow({ "1": 10, "99": 90 }, [0, 255])).toEqual({ level: 50, width: 80 });
    expect(percentileWindow({ "1": 0, "99": 0 }, [0, 255])).toEqual({ level: 127.5, width: 255 });
  });
});
