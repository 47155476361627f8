import { describe, expect, it } from "vitest";
import { decodeScene, encodeScene } from "../src/shell/link";

describe("scenes in links", () => {
  const scene = {
    version: 1,
    volume: { path: "Köpfe/ct.nrrd" },
    transfer: { points: Array(50).fill({ value: 1.25, opacity: 0.5 }) },
  };
  it("come back as they were, in characters that links may have", async () => {
    const link = await encodeScene(scene);
    expect(link).toMatch(/^#scene=[A-Za-z0-9_-]+$/);
    expect(link.length).toBeLessThan(JSON.stringify(scene).length / 4);
    expect(await decodeScene(link)).toEqual(scene);
  });
  it("are absent or refused, never half read", async () => {
    expect(await decodeScene("#other")).toBeNull();
    const link = await encodeScene(scene);
    await expect(decodeScene(link.slice(0, -12))).rejects.toThrow("damaged");
    await expect(decodeScene("#scene=%%%")).rejects.toThrow("damaged");
  });
});
