import { describe, expect, it } from "vitest";
import type { PaneView } from "../src/model/slice";
import { slicePane } from "../src/slices/slice-input";
import type { VolumeFacts } from "../src/state/volume";
import { lengthOf } from "../src/view/distances";
import { cursorStep } from "../src/view/key-cursor";

describe("measuring", () => {
  it("writes lengths to a tenth of a millimetre, long ones to one", () => {
    expect(lengthOf({ a: [1, 2, 3], b: [4, 6, 3] })).toBe("5.0 mm");
    expect(lengthOf({ a: [0, 0, 0], b: [0, 0, 123.4] })).toBe("123 mm");
  });

  it("has a cursor that arrow keys move on the screen, ten times as far with Shift", () => {
    expect(cursorStep("ArrowUp", false)).toEqual([0, -1]);
    expect(cursorStep("ArrowRight", true)).toEqual([10, 0]);
    expect(cursorStep("PageUp", false)).toBeNull();
  });

  describe("in a slice", () => {
    const facts = {
      size: [200, 200, 20],
      spacing_mm: [0.5, 0.5, 2],
      direction: [1, 0, 0, 0, 1, 0, 0, 0, 1],
      bounds_mm: [[-50, -50, -10], [50, 50, 30]],
    } as unknown as VolumeFacts;
    const pane: PaneView = { width: 200, height: 100, center_mm: [0, 0, 10], pxPerMm: 2 };
    const axial = slicePane("axial", pane, 10, facts);

    it("shows what lies in the slice or within a voxel of the plane, where it is", () => {
      expect(axial.place([5, -5, 11])).toEqual({ x: 110, y: 40 });
      expect(axial.place([5, -5, 8.9])).toBeNull();
      const coronal = slicePane("coronal", pane, 0, facts);
      expect(coronal.place([5, 0.5, 10])).toEqual({ x: 110, y: 50 });
      expect(coronal.place([5, -0.6, 10])).toBeNull();
    });

    it("asks about points of its plane", () => {
      expect(axial.at(110, 40)).toEqual([5, -5, 10]);
    });
  });
});
