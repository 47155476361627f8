import { describe, expect, it } from "vitest";
import { formatNumber, formatValue, panSpan, ticks, toPixel, toValue, zoomSpan } from "../../src/model/axis";
import { jointHeights, logHeights } from "../../src/model/histogram";

const whole = { lo: 0, hi: 1000 };

describe("the value axis", () => {
  it("keeps the value under the pointer when it is zoomed", () => {
    const near = zoomSpan(whole, whole, 250, 0.5);
    expect(near).toEqual({ lo: 125, hi: 625 });
    expect(toPixel(near, 300, 250)).toBeCloseTo(toPixel(whole, 300, 250));
    expect(toValue(near, 300, toPixel(near, 300, 400))).toBeCloseTo(400);
  });

  it("stays within its limits", () => {
    expect(zoomSpan({ lo: 0, hi: 500 }, whole, 0, 100)).toEqual(whole);
    expect(panSpan({ lo: 100, hi: 300 }, whole, 5000)).toEqual({ lo: 800, hi: 1000 });
    const nearest = zoomSpan(whole, whole, 500, 1e-9);
    expect(nearest.hi - nearest.lo).toBeCloseTo(1);
  });

  it("has round ticks", () => {
    expect(ticks({ lo: -930, hi: 2900 }, 5)).toEqual([0, 1000, 2000]);
    expect(ticks({ lo: 0, hi: 1 }, 4)).toEqual([0, 0.5, 1]);
  });

  it("writes numbers as exactly as matters", () => {
    expect(formatNumber(123.456, 1)).toBe("123");
    expect(formatNumber(123.456, 0.1)).toBe("123.5");
    expect(formatNumber(0, 1)).toBe("0");
    expect(formatNumber(100, 1)).toBe("100");
    expect(formatNumber(2.5e9, 1e6)).toBe("2.50e+9");
  });

  it("writes data values by their range and with their unit", () => {
    expect(formatValue(40.04, { hounsfield: true, range: [-1024, 3071] })).toBe("40 HU");
    expect(formatValue(-312.46, { hounsfield: true, range: [-1024, 3071] })).toBe("-312.5 HU");
    expect(formatValue(0.12345, { hounsfield: false, range: [0, 1] })).toBe("0.123");
    expect(formatValue(1e-7, { hounsfield: false, range: [0, 1] })).toBe("0");
  });
});

describe("the histogram", () => {
  const histogram = { lo: 0, hi: 4, counts: [9, 0, 99, 1] };

  it("has logarithmic heights relative to the greatest count", () => {
    const heights = logHeights(histogram, { lo: 0, hi: 4 }, 4);
    expect(heights[2]).toBe(1);
    expect(heights[0]).toBeCloseTo(0.5);
    expect(heights[1]).toBe(0);
  });

  it("shows the greatest count where a column has several bins, and keeps heights when zoomed", () => {
    expect(logHeights(histogram, { lo: 0, hi: 4 }, 2)).toEqual([0.5, 1]);
    expect(logHeights(histogram, { lo: 0, hi: 1 }, 2)).toEqual([0.5, 0.5]);
  });

  it("is empty beyond the data and where nothing was counted", () => {
    expect(logHeights(histogram, { lo: 10, hi: 12 }, 3)).toEqual([0, 0, 0]);
    expect(logHeights({ lo: 0, hi: 1, counts: [0, 0] }, { lo: 0, hi: 1 }, 2)).toEqual([0, 0]);
  });
});

describe("the joint histogram", () => {
  const histogram = {
    x: { lo: 0, hi: 2 },
    y: { lo: 0, hi: 3 },
    columns: 2,
    rows: 3,
    counts: [0, 99, 9, 0, 0, 1],
  };

  it("has y upward and logarithmic heights", () => {
    const heights = jointHeights(histogram, { lo: 0, hi: 2 }, { lo: 0, hi: 3 }, 2, 3);
    const low = Math.log1p(1) / Math.log1p(99);
    [0, low, 0.5, 0, 0, 1].forEach((height, i) => expect(heights[i]).toBeCloseTo(height));
  });

  it("is empty beyond its ends, and shows the greatest of what a cell meets", () => {
    expect(jointHeights(histogram, { lo: 0, hi: 4 }, { lo: -3, hi: 3 }, 2, 2)).toEqual([1, 0, 0, 0]);
  });

  it("is nothing without counts", () => {
    expect(jointHeights({ ...histogram, counts: [0, 0, 0, 0, 0, 0] }, histogram.x, histogram.y, 1, 1)).toEqual([0]);
  });
});
