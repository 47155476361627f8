import { describe, expect, it } from "vitest";
import { labelPainter, paintsOf, volumesBeside } from "../../src/model/label-paint";
import { hiddenExtinction, writeLooks, type LabelLook } from "../../src/model/label-rules";
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
  [4, { hidden: true }],
  [11, { color: "#30c040" }],
  [37, { opacity: 0.9 }],
]);

describe("labels as they are seen", () => {
  const gold = (name: string) => (name === "gold" ? "#d0a030" : undefined);
  const paint = (rules: Rule[], value: number, merge: "priority" | "product" | "maximum" = "priority") =>
    paintsOf({ rules, merge }, "atlas", [value], gold).get(value);

  it("have the color of their look or of its material, or none of the scene's", () => {
    const rules = writeLooks([], "atlas", new Map([...looks, [5, { material: "gold" }]]));
    expect(paint(rules, 11)).toEqual({ hidden: false, color: "#30c040" });
    expect(paint(rules, 5)).toEqual({ hidden: false, color: "#d0a030" });
    expect(paint(rules, 9)).toEqual({ hidden: false });
    expect(paint(rules, 77)).toEqual({ hidden: false });
    expect(paint(rules, 4)?.hidden).toBe(true);
  });

  it("have the first color that a rule of their volume gives, also by steps and curves", () => {
    const steps = rule("cpctf", "atlas", [
      { value: 1, color: "#010101" },
      { value: 5, color: "#050505" },
    ]);
    const one = rule("cdptf", "atlas", [{ value: 3, color: "#030303", roughness: 0.5 }]);
    expect(paint([one, steps], 3)?.color).toBe("#030303");
    expect(paint([steps, one], 3)?.color).toBe("#010101");
    expect(paint([one, steps], 6)?.color).toBe("#050505");
    expect(paint([one, steps], 0)?.color).toBeUndefined();
    expect(paint([{ ...one, volume: "data" }], 3)?.color).toBeUndefined();
    const curve = rule("cctf", "atlas", [
      { value: 0, color: { linear: [0, 0, 0] } },
      { value: 4, color: { linear: [1, 0, 0] } },
    ]);
    expect(paint([curve], 1)?.color).toEqual({ linear: [0.25, 0, 0] });
  });

  it("are hidden by the first rule that decides, by any factor of a product, never as the greatest", () => {
    const clear = rule("cdptf", "atlas", [{ value: 1, mu_t_per_mm: hiddenExtinction }]);
    const dense = rule("cdptf", "atlas", [{ value: 1, opacity: 0.9 }]);
    expect(paint([clear, dense], 1)?.hidden).toBe(true);
    expect(paint([dense, clear], 1)?.hidden).toBe(false);
    expect(paint([dense, clear], 1, "product")?.hidden).toBe(true);
    expect(paint([dense], 2, "product")?.hidden).toBe(true);
    expect(paint([dense], 2)?.hidden).toBe(false);
    expect(paint([clear, dense], 1, "maximum")?.hidden).toBe(false);
  });

  it("have the color that rules of two dimensions give them where the data has a value", () => {
    const black = { linear: [0, 0, 0] } as const;
    const white = { linear: [1, 1, 1] } as const;
    const plane = (of: Partial<Rule>): Rule => ({ ...rule("cdptf", "atlas", []), along: "data", ...of });
    const at = (rules: Rule[], label: number, data: number | undefined, merge: "priority" | "product" = "priority") =>
      labelPainter({ rules, merge }, "atlas", gold)(label, (name) => (name === "data" ? data : undefined));
    const columns = [
      { at: 100, points: [{ value: 1, color: black }] },
      { at: 200, points: [{ value: 1, color: white }, { value: 2, color: "#020202" }] },
    ];
    const curve = plane({ columns });
    expect(volumesBeside([curve], "atlas")).toEqual(["data"]);
    expect(volumesBeside([curve], "tumour")).toEqual([]);
    expect(at([curve], 1, 50).color).toEqual(black);
    expect(at([curve], 1, 125).color).toEqual({ linear: [0.25, 0.25, 0.25] });
    expect(at([curve], 1, 300).color).toEqual(white);
    // Of one column alone it is its own, and none beside the data.
    expect(at([curve], 2, 110).color).toBe("#020202");
    expect(at([curve], 2, 50).color).toBeUndefined();
    expect(at([curve], 1, undefined).color).toBeUndefined();
    expect(at([plane({ columns, column_form: "steps" })], 1, 199).color).toEqual(black);
    expect(at([plane({ columns, column_form: "steps" })], 1, 99).color).toBeUndefined();
    // The first rule that gives one, of either kind.
    const one = rule("cdptf", "atlas", [{ value: 1, color: "#010101" }]);
    expect(at([one, curve], 1, 150).color).toBe("#010101");
    expect(at([curve, one], 1, 150).color).toEqual({ linear: [0.5, 0.5, 0.5] });
    // Labels along a function of the data.
    const along: Rule = {
      ...rule("cctf", "data", []),
      along: "atlas",
      column_form: "points",
      columns: [{ at: 3, points: [{ value: 0, color: black }, { value: 100, color: white }] }],
    };
    expect(at([along], 3, 25).color).toEqual({ linear: [0.25, 0.25, 0.25] });
    expect(at([along], 2, 25).color).toBeUndefined();
    expect(paintsOf({ rules: [along], merge: "priority" }, "atlas", [3], gold).get(3)).toEqual({ hidden: false });
    const material = { ...along, kind: "mpctf" as const, columns: [{ at: 3, points: [{ value: 50, material: "gold" }] }] };
    expect(at([material], 3, 60).color).toBe("#d0a030");
  });

  it("are hidden by rules of two dimensions where these leave no matter", () => {
    const opacities = (low: number, high: number): Rule => ({
      ...rule("cdptf", "atlas", []),
      along: "data",
      columns: [
        { at: 0, points: [{ value: 1, opacity: low, color: "#ff0000" }] },
        { at: 100, points: [{ value: 1, opacity: high, color: "#0000ff" }] },
      ],
    });
    const at = (rules: Rule[], data: number, merge: "priority" | "product") =>
      labelPainter({ rules, merge }, "atlas", gold)(1, () => data);
    // A column without matter has no color, and where the rule has none another one decides.
    expect(at([opacities(0, 0.5)], 50, "priority")).toEqual({ hidden: false, color: "#0000ff" });
    expect(at([opacities(0, 0.5)], 0, "priority")).toEqual({ hidden: false });
    expect(at([opacities(0, 0.5)], 0, "product").hidden).toBe(true);
    expect(at([opacities(0, 0.5)], 10, "product").hidden).toBe(false);
  });
});
