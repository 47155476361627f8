import { describe, expect, it } from "vitest";
import {
  addPoint,
  colorAt,
  extinctionOfOpacity,
  movePoint,
  numberAt,
  opacityAt,
  opacityOfExtinction,
  removePoint,
  shiftPoints,
  withCoefficient,
} from "../../src/model/curve";

const bone = [
  { value: 100, opacity: 0, color: "#000000" },
  { value: 300, opacity: 0.8, color: "#ffffff", roughness: 0.2 },
  { value: 500, opacity: 0.9 },
];
const limits = { lo: -1000, hi: 3000 };

describe("curves", () => {
  it("are linear between the points that give a coefficient and constant beyond them", () => {
    expect(opacityAt(bone, 200, 1)).toBeCloseTo(0.4);
    expect(opacityAt(bone, 50, 1)).toBe(0);
    expect(opacityAt(bone, 900, 1)).toBe(0.9);
    expect(numberAt(bone, 0, "roughness")).toBe(0.2);
    expect(numberAt(bone, 0, "metallic")).toBeUndefined();
  });

  it("have what is above a step at its value", () => {
    const step = [
      { value: 10, opacity: 0.1 },
      { value: 10, opacity: 0.7 },
    ];
    expect(opacityAt(step, 9.99, 1)).toBeCloseTo(0.1);
    expect(opacityAt(step, 10, 1)).toBe(0.7);
  });

  it("mix colors in linear light", () => {
    expect(colorAt(bone, 200)![0]).toBeCloseTo(0.5);
  });

  it("turn opacities to extinctions and back", () => {
    expect(opacityOfExtinction(extinctionOfOpacity(0.37, 0.8), 0.8)).toBeCloseTo(0.37);
    expect(Number.isFinite(extinctionOfOpacity(1, 1))).toBe(true);
  });
});

describe("editing points", () => {
  it("adds a point that leaves the other coefficients' curves as they are", () => {
    const { points, selected } = addPoint(bone, 200, 0.9, 1);
    expect(selected).toBe(1);
    expect(points.map((p) => p.value)).toEqual([100, 200, 300, 500]);
    expect(points[1]!.opacity).toBe(0.9);
    expect(colorAt(points, 150)![0]).toBeCloseTo(colorAt(bone, 150)![0]);
    expect(colorAt(points, 250)![0]).toBeCloseTo(colorAt(bone, 250)![0]);
  });

  it("adds extinctions to a function of extinctions", () => {
    const { points } = addPoint([{ value: 0, mu_t_per_mm: 0.1 }], 5, 0.5, 2);
    expect(points[1]!.opacity).toBeUndefined();
    expect(points[1]!.mu_t_per_mm).toBeCloseTo(Math.log(2) / 2);
  });

  it("gives the first point of an empty function a color", () => {
    expect(addPoint([], 5, 0.5, 1).points[0]).toEqual({ value: 5, opacity: 0.5, color: "#e6e6e6" });
  });

  it("stops a moved point at its neighbours and at the limits", () => {
    expect(movePoint(bone, 1, 700, limits)[1]!.value).toBe(500);
    expect(movePoint(bone, 1, 0, limits)[1]!.value).toBe(100);
    expect(movePoint(bone, 2, 9999, limits)[2]!.value).toBe(3000);
  });

  it("lets a point beyond the data be where it is", () => {
    expect(movePoint([{ value: 5000, opacity: 1 }], 0, 4900, limits)[0]!.value).toBe(4900);
  });

  it("selects the neighbour of a removed point, and none at last", () => {
    expect(removePoint(bone, 2).selected).toBe(1);
    expect(removePoint([bone[0]!], 0).selected).toBe(-1);
  });

  it("shifts all points by the same", () => {
    expect(shiftPoints(bone, -50).map((p) => p.value)).toEqual([50, 250, 450]);
  });

  it("takes a coefficient away where it is undefined", () => {
    expect(withCoefficient(bone[1]!, "roughness", undefined)).toEqual({ value: 300, opacity: 0.8, color: "#ffffff" });
    expect(withCoefficient(bone[1]!, "metallic", 1).metallic).toBe(1);
  });
});
