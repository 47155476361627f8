import { computed, type ReadonlySignal } from "@preact/signals";
import { toHex } from "../color";
import { extinctionOfOpacity, opacityAt, opacityOfExtinction } from "../model/curve";
import { labelPainter, paintsOf, volumesBeside, type Elsewhere } from "../model/label-paint";
import { unlabelled } from "../model/label-rules";
import type { Color, Transfer } from "./scene-types";
import { section } from "./scene";
import { hello } from "./session";
import { labels } from "./volume";

/** The colors that labels have in the scene, wherever the page shows them. */

const transfer = section("transfer");
const materials = section("materials");

/** The color of a material, one of the scene's own or of the library; undefined where it leaves that open. */
export function materialColor(name: string): Color | undefined {
  const own = materials.value?.find((material) => material.name === name);
  if (own?.color) return own.color as Color;
  const library = own ? own.like : name;
  return hello.value?.materials.find((material) => material.name === library)?.color;
}

/** A label as it is seen: "#rrggbb", the file's own where no rule of the scene gives it a color. */
export interface LabelColor {
  color: string;
  hidden: boolean;
}

/** By label volume and label, also of what no label marks. */
export const labelColors: ReadonlySignal<Record<string, ReadonlyMap<number, LabelColor>>> = computed(() => {
  const rules = transfer.value ?? { rules: [], merge: "priority" as const };
  const colorsOf = (volume: string) => {
    const listed = [unlabelled, ...(labels.value[volume] ?? [])];
    const paints = paintsOf(
      rules,
      volume,
      listed.map((label) => label.value),
      materialColor,
    );
    return new Map(
      listed.map(({ value, color }) => {
        const paint = paints.get(value)!;
        return [value, { color: paint.color ? toHex(paint.color) : color, hidden: paint.hidden }];
      }),
    );
  };
  return Object.fromEntries(Object.keys(labels.value).map((volume) => [volume, colorsOf(volume)]));
});

/** How slices show the labels of a volume. */
export interface LabelPainting {
  /** The volumes whose values decide, too: "data" and proxies. */
  beside: readonly string[];
  /** A label where the volumes of `beside` have values; undefined where there is no such label. */
  at(label: number, elsewhere: Elsewhere): LabelColor | undefined;
}

/** `elsewhere` with what rules read as "opacity": that of the curve, which is a function of the data. */
function withOpacity(of: Transfer, elsewhere: Elsewhere): Elsewhere {
  const length_mm = of.reference_length_mm ?? 1;
  return (name) => {
    const data = name === "opacity" ? elsewhere("data") : undefined;
    if (data === undefined) return elsewhere(name);
    const curve = extinctionOfOpacity(opacityAt(of.points, data, length_mm), length_mm);
    return opacityOfExtinction(of.density_scale * curve, length_mm);
  };
}

/** By label volume: as labelColors, and by rules of two dimensions. */
export const labelPaintings: ReadonlySignal<Record<string, LabelPainting>> = computed(() => {
  const of = transfer.value;
  const paintingOf = (volume: string): LabelPainting => {
    const colors = labelColors.value[volume]!;
    const read = of ? volumesBeside(of.rules, volume) : [];
    if (!of || read.length === 0) return { beside: [], at: (label) => colors.get(label) };
    const painter = labelPainter(of, volume, materialColor);
    const own = new Map((labels.value[volume] ?? []).map(({ value, color }) => [value, color]));
    return {
      beside: [...new Set(read.map((name) => (name === "opacity" ? "data" : name)))],
      at: (label, elsewhere) => {
        if (!colors.has(label)) return undefined;
        const { color, hidden } = painter(label, withOpacity(of, elsewhere));
        return { color: color ? toHex(color) : (own.get(label) ?? unlabelled.color), hidden };
      },
    };
  };
  return Object.fromEntries(Object.keys(labels.value).map((volume) => [volume, paintingOf(volume)]));
});
