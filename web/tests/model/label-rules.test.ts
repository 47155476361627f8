import { describe, expect, it } from "vitest";
import {
  hasOtherRules,
  hiddenExtinction,
  readLooks,
  titleOf,
  withLook,
  writeLooks,
  type LabelLook,
} from "../../src/model/label-rules";
import type { Rule } from "../../src/state/scene-types";

const rule = (kind: Rule["kind"], volume: string, points: Rule["points"]): Rule => ({
  kind,
  volume,
  points,
  along: "",
  column_form: "curve",
  columns: [],
});

const looks = new Map<number, LabelLook>([
  [37, { material: "lesion", opacity: 0.9 }],
  [4, { hidden: true }],
  [2, { hidden: true }],
  [9, { material: "vein" }],
  [11, { color: "#30c040" }],
  [12, { color: "#30c040", opacity: 0.5 }],
]);

describe("looks of labels as rules", () => {
  it("come back as they were", () => {
    expect(readLooks(writeLooks([], "atlas", looks), "atlas")).toEqual(looks);
  });

  it("put hidden labels first, above 0 so that no rule after them applies", () => {
    const [hidden] = writeLooks([], "atlas", looks);
    expect(hidden!.points).toEqual([
      { value: 2, mu_t_per_mm: hiddenExtinction },
      { value: 4, mu_t_per_mm: hiddenExtinction },
    ]);
    expect(hiddenExtinction).toBeGreaterThan(0);
  });

  it("never mix points with and without an extinction in a rule, and sort them", () => {
    for (const { points } of writeLooks([], "atlas", looks)) {
      const dense = points.map((p) => p.opacity !== undefined || p.mu_t_per_mm !== undefined);
      expect(new Set(dense).size).toBe(1);
      expect(points.map((p) => p.value)).toEqual(points.map((p) => p.value).sort((a, b) => a - b));
    }
  });

  it("name materials in material rules only, and in all their points", () => {
    for (const { kind, points } of writeLooks([], "atlas", looks))
      for (const p of points) expect(p.material !== undefined).toBe(kind === "mdptf");
  });

  it("leave other rules where they are", () => {
    const curve = rule("cctf", "data", [{ value: 1, opacity: 1 }]);
    const steps = rule("mpctf", "atlas", [{ value: 1, material: "bone", opacity: 1 }]);
    const other = rule("cdptf", "tumour", [{ value: 1, color: "#ff0000" }]);
    const own = rule("cdptf", "atlas", [{ value: 1, color: "#ff0000" }]);
    const written = writeLooks([curve, own, other, steps], "atlas", new Map([[3, { hidden: true }]]));
    expect(written.map((r) => r.points[0]!.value)).toEqual([1, 3, 1, 1]);
    expect(written[0]).toBe(curve);
    expect(written.slice(2)).toEqual([other, steps]);
    expect(writeLooks([curve, own], "atlas", new Map())).toEqual([curve]);
    expect(hasOtherRules([steps], "atlas")).toBe(true);
    expect(hasOtherRules([own], "atlas")).toBe(false);
  });

  it("do not touch rules that say more than a look can", () => {
    const rough = rule("cdptf", "atlas", [{ value: 1, color: "#ff0000", roughness: 0.1 }]);
    expect(readLooks([rough], "atlas").size).toBe(0);
    expect(writeLooks([rough], "atlas", new Map())).toEqual([rough]);
  });

  it("are the first rule's where two speak of a label", () => {
    const read = readLooks(
      [rule("cdptf", "a", [{ value: 1, color: "#ff0000" }]), rule("cdptf", "a", [{ value: 1, color: "#00ff00" }])],
      "a",
    );
    expect(read.get(1)).toEqual({ color: "#ff0000" });
  });

  it("are dropped when they say nothing", () => {
    expect(withLook(looks, 4, { hidden: false }).has(4)).toBe(false);
    expect(withLook(looks, 37, { material: undefined }).get(37)).toEqual({ opacity: 0.9 });
  });
});

describe("labels", () => {
  it("have titles that can be read", () => {
    expect(titleOf({ value: 3, name: "Frontal_Mid_L" })).toBe("Frontal Mid L");
    expect(titleOf({ value: 3, name: "" })).toBe("Label 3");
    expect(titleOf({ value: 0, name: "" })).toBe("Unlabelled");
  });
});
