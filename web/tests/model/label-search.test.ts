import { describe, expect, it } from "vitest";
import { isSought } from "../../src/model/label-search";

describe("a search for labels", () => {
  const found = (search: string, names: readonly string[]) => names.filter((name) => isSought(2201, name, search));
  const both = (name: string) => [`${name}_L`, `${name}_R`];

  it("matches words from their beginning", () => {
    expect(found("frontal mid l", [...both("Frontal_Mid"), ...both("Frontal_Mid_Orb")])).toEqual([
      "Frontal_Mid_L",
      "Frontal_Mid_Orb_L",
    ]);
    expect(found("mid front", both("Frontal_Mid"))).toEqual(both("Frontal_Mid"));
    expect(found("rontal", both("Frontal_Mid"))).toEqual([]);
    expect(found("frontal_mid", both("Frontal_Mid"))).toEqual(both("Frontal_Mid"));
  });

  it("takes each word of a name once", () => {
    expect(found("rectus r", both("Rectus"))).toEqual(["Rectus_R"]);
    expect(found("l lingual", both("Lingual"))).toEqual(["Lingual_L"]);
    expect(found("lingual lingual", both("Lingual"))).toEqual([]);
  });

  it("knows words in one and numbers", () => {
    expect(found("hippo", ["ParaHippocampal_L"])).toEqual(["ParaHippocampal_L"]);
    expect(found("17", ["BA17", "BA18"])).toEqual(["BA17"]);
    expect(found("cerebral-white", ["Left-Cerebral-White-Matter"])).toEqual(["Left-Cerebral-White-Matter"]);
    expect(isSought(2201, "Precentral", "22")).toBe(true);
    expect(isSought(2201, "Precentral", "01")).toBe(false);
    expect(isSought(1, "Größe", "größe")).toBe(true);
    expect(isSought(1, "any", "")).toBe(true);
  });
});
