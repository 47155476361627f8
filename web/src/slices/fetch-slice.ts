import { effect } from "@preact/signals";
import type { SliceHeader } from "../model/slice";
import { section } from "../state/scene";
import { volume } from "../state/volume";

/** A plane's samples, as /api/slice gives them. */
export interface Slice {
  header: SliceHeader;
  samples: Uint16Array;
}

/** Enough to scroll back and forth without asking again. */
const kKept = 96;
const kept = new Map<string, Slice>();

/** Which opening of a volume slices are of: another file, or another proxy of a name, may have planes at the same
 * places. */
let opening = 0;
const proxies = section("proxies");
effect(() => {
  void volume.value;
  void proxies.value;
  ++opening;
  kept.clear();
});

/** The plane across `axis` at `mm`, of the data or of a proxy (`of`). Throws Error with the server's line of text. */
export async function fetchSlice(axis: "x" | "y" | "z", mm: number, of: string, signal: AbortSignal): Promise<Slice> {
  const path = `api/slice?axis=${axis}&mm=${Number(mm.toPrecision(9))}${of ? `&of=${encodeURIComponent(of)}` : ""}`;
  const known = kept.get(path);
  if (known) return known;
  const askedIn = opening;
  const response = await fetch(path, { signal });
  if (!response.ok) throw new Error((await response.text()).trim());
  const header = JSON.parse(response.headers.get("X-Slice") ?? "null") as SliceHeader | null;
  if (!header) throw new Error(`${path}: no X-Slice header`);
  const bytes = await response.arrayBuffer();
  const view = new DataView(bytes);
  const samples = Uint16Array.from({ length: header.width * header.height }, (_, i) => view.getUint16(2 * i, true));
  const slice = { header, samples };
  if (askedIn !== opening) return slice;
  kept.set(path, slice);
  if (kept.size > kKept) kept.delete(kept.keys().next().value!);
  return slice;
}
