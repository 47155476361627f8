import { computed, type ReadonlySignal } from "@preact/signals";
import { toHex } from "../color";
import { paintsOf, unlabelled } from "../model/label-rules";
import type { Color } from "./scene-types";
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
