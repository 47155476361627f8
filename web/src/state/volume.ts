import { signal, type ReadonlySignal } from "@preact/signals";
import { on } from "./connection";
import type { Range, Vec3 } from "./scene-types";

/** The open volume's facts, fetched when one is opened. */

export interface Histogram {
  lo: number;
  hi: number;
  counts: number[];
}

/** How often values of two volumes are at the same place: `rows` times `columns` counts, those of the lowest y first. */
export interface JointHistogram {
  x: { lo: number; hi: number };
  y: { lo: number; hi: number };
  columns: number;
  rows: number;
  counts: number[];
}

export interface VolumeFacts {
  name: string;
  size: Vec3;
  spacing_mm: Vec3;
  /** 3 x 3, row by row: column a is the LPS direction of index axis a. */
  direction: readonly number[];
  type: string;
  modality: string;
  bounds_mm: readonly [Vec3, Vec3];
  range: Range;
  /** Keys "0.1", "1", "5", "50", "95", "99", "99.9". */
  percentiles: Record<string, number>;
  histogram: Histogram;
  hounsfield: boolean;
  voxels: number;
  warnings: string[];
}

export interface LabelName {
  value: number;
  name: string;
  color: string;
}

const facts = signal<VolumeFacts | null>(null);
/** The open volume; null while none is. */
export const volume: ReadonlySignal<VolumeFacts | null> = facts;

const labelNames = signal<Record<string, LabelName[]>>({});
/** Labels that occur, by proxy name, and "labels" for /labels of the scene. */
export const labels: ReadonlySignal<Record<string, LabelName[]>> = labelNames;

/** GET of an /api path; throws Error with the server's line of text. */
export async function getJson<T>(path: string): Promise<T> {
  const response = await fetch(path);
  if (!response.ok) throw new Error((await response.text()).trim() || `${path}: ${response.status}`);
  return (await response.json()) as T;
}

let asked = 0;

/** Fetches both anew: when a volume was opened, or label volumes of the scene changed. */
export async function refreshVolume(): Promise<void> {
  const turn = ++asked;
  const [newFacts, newLabels] = await Promise.all([
    getJson<VolumeFacts>("api/volume").catch(() => null),
    getJson<Record<string, LabelName[]>>("api/labels").catch(() => ({})),
  ]);
  if (turn !== asked) return;
  facts.value = newFacts;
  labelNames.value = newLabels;
}

/** The histogram of a proxy (gradients and files). */
export function fetchHistogram(of: string): Promise<Histogram> {
  return getJson<Histogram>(`api/histogram?of=${encodeURIComponent(of)}`);
}

/** Of two volumes by their names in rules; not of "opacity". */
export function fetchJointHistogram(x: string, y: string): Promise<JointHistogram> {
  return getJson<JointHistogram>(`api/histogram2?x=${encodeURIComponent(x)}&y=${encodeURIComponent(y)}`);
}

on("scene", () => void refreshVolume());
on("edited", (message) => {
  if ("proxies" in message.sections || "labels" in message.sections) void refreshVolume();
});
on("status", (message) => {
  if (message.stage === "empty") facts.value = null;
});
