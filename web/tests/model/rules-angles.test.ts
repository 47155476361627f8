import { describe, expect, it } from "vitest";
import { anglesOf, directionOf, wrapDegrees } from "../../src/model/angles";
import { newestWins } from "../../src/model/latest";
import { addColumn, moveColumn, moved, newRule, sampleRule, withAlong, withKind } from "../../src/model/rules";

const span = { lo: 0, hi: 100 };
const gray = () => "#808080";

describe("angles of lights", () => {
  it("look at the patient's face at 0, 0 and go toward the left and the head", () => {
    const close = (a: readonly number[], b: readonly number[]) => a.forEach((x, i) => expect(x).toBeCloseTo(b[i]!));
    close(directionOf({ azimuthDeg: 0, elevationDeg: 0 }, "world"), [0, -1, 0]);
    close(directionOf({ azimuthDeg: 90, elevationDeg: 0 }, "world"), [1, 0, 0]);
    close(directionOf({ azimuthDeg: 0, elevationDeg: 90 }, "world"), [0, 0, 1]);
    close(directionOf({ azimuthDeg: 0, elevationDeg: 0 }, "camera"), [0, 0, 1]);
    close(directionOf({ azimuthDeg: 90, elevationDeg: 0 }, "camera"), [1, 0, 0]);
    close(directionOf({ azimuthDeg: 0, elevationDeg: 90 }, "camera"), [0, 1, 0]);
  });

  it.each(["world", "camera"] as const)("come back from directions of any length (%s)", (attached) => {
    const [x, y, z] = directionOf({ azimuthDeg: -130, elevationDeg: 35 }, attached);
    const back = anglesOf([7 * x, 7 * y, 7 * z], attached);
    expect(back.azimuthDeg).toBeCloseTo(-130);
    expect(back.elevationDeg).toBeCloseTo(35);
  });

  it("wrap", () => {
    expect(wrapDegrees(190)).toBe(-170);
    expect(wrapDegrees(-540)).toBe(-180);
    expect(wrapDegrees(30)).toBe(30);
  });
});

describe("rules", () => {
  it("are curves, steps or single values", () => {
    const curve = newRule("cctf", "data", span);
    expect(sampleRule(curve, 60, 0, gray)!.opacity).toBeCloseTo(0.3);
    const steps = newRule("cpctf", "data", span);
    expect(sampleRule(steps, 50, 0, gray)).toBeNull();
    expect(sampleRule(steps, 70, 0, gray)!.opacity).toBe(0.9);
    const single = { ...newRule("cdptf", "data", span), points: [{ value: 7, opacity: 0.4 }] };
    expect(sampleRule(single, 7, 0, gray)!.opacity).toBe(0.4);
    expect(sampleRule(single, 8, 0, gray)).toBeNull();
  });

  it("interpolate columns, hold them, or have them at their value", () => {
    const base = { ...newRule("cctf", "data", span), along: "edges", points: [] };
    const columns = [
      { at: 0, points: [{ value: 0, opacity: 0 }] },
      { at: 10, points: [{ value: 0, opacity: 1 }] },
    ];
    const at = (column_form: "curve" | "steps" | "points", along: number) =>
      sampleRule({ ...base, column_form, columns }, 0, along, gray)?.opacity;
    expect(at("curve", 5)).toBeCloseTo(0.5);
    expect(at("curve", -5)).toBe(0);
    expect(at("curve", 50)).toBe(1);
    expect(at("steps", 9)).toBe(0);
    expect(at("steps", -1)).toBeUndefined();
    expect(at("points", 10)).toBe(1);
    expect(at("points", 5)).toBeUndefined();
  });

  it("become two-dimensional and back without losing their points", () => {
    const rule = newRule("cctf", "data", span);
    const plane = withAlong(rule, "edges", span, false);
    expect(plane.points).toEqual([]);
    expect(plane.columns[1]!.points).toEqual(rule.points);
    expect(plane.columns[0]!.points.every((p) => p.opacity === 0)).toBe(true);
    expect(withAlong({ ...plane, columns: [plane.columns[1]!] }, "", span, false).points).toEqual(rule.points);
  });

  it("gain and lose materials with their kind", () => {
    const rule = {
      ...newRule("cctf", "data", span),
      points: [
        { value: 1.2, opacity: 1 },
        { value: 1.4, opacity: 0.5 },
      ],
    };
    const materials = withKind(rule, "mdptf");
    expect(materials.points).toEqual([{ value: 1, opacity: 1, material: "lesion" }]);
    expect(withKind(materials, "cctf").points).toEqual([{ value: 1, opacity: 1 }]);
  });

  it("keep columns sorted and apart", () => {
    const { columns, selected } = addColumn(
      [
        { at: 0, points: [{ value: 5 }] },
        { at: 10, points: [] },
      ],
      3,
    );
    expect(selected).toBe(1);
    expect(columns.map((c) => c.at)).toEqual([0, 3, 10]);
    expect(columns[1]!.points).toEqual([{ value: 5 }]);
    expect(addColumn(columns, 3).columns.length).toBe(3);
    expect(moveColumn(columns, 1, 50, 1)[1]!.at).toBe(9);
  });

  it("change places", () => {
    expect(moved(["a", "b", "c"], 0, 2)).toEqual(["b", "c", "a"]);
    expect(moved(["a", "b", "c"], 2, -5)).toEqual(["c", "a", "b"]);
  });
});

describe("requests of which the newest wins", () => {
  it("run one at a time and skip what is out of date", async () => {
    const done: number[] = [];
    let release: () => void = () => {};
    const requests = newestWins<number>(
      (n) =>
        new Promise((resolve) => {
          release = () => {
            done.push(n);
            resolve();
          };
        }),
      () => {},
    );
    const settle = () => new Promise((resolve) => setTimeout(resolve));
    for (const n of [1, 2, 3]) requests.ask(n);
    release();
    await settle();
    release();
    await settle();
    expect(done).toEqual([1, 3]);
  });

  it("go on after a failure", async () => {
    const failures: unknown[] = [];
    const requests = newestWins<number>(
      async () => {
        throw new Error("no");
      },
      (error) => failures.push(error),
    );
    requests.ask(1);
    await new Promise((resolve) => setTimeout(resolve));
    requests.ask(2);
    await new Promise((resolve) => setTimeout(resolve));
    expect(failures.length).toBe(2);
  });
});
