import { describe, expect, it } from "vitest";
import {
  canvasOf,
  fitSlice,
  planeNames,
  planes,
  pointOf,
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

describe("slices on the screen", () => {
  const placement = fitSlice(header, 400, 400);

  it("fit with square samples in the middle", () => {
    expect(placement).toEqual({ left: 0, top: 100, zoom: 4 });
  });

  it.each(planeNames)("the %s plane has the patient's sides where its letters say", (name) => {
    const layout = planes[name];
    const at = (p: Vec3) => canvasOf(layout, header, placement, p);
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
    const [x, y] = canvasOf(layout, header, placement, p);
    const back = pointOf(layout, header, placement, p[layout.normal], x, y);
    back.forEach((value, i) => expect(value).toBeCloseTo(p[i]!));
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
