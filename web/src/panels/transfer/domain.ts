import { useEffect, useState } from "preact/hooks";
import type { Span } from "../../model/axis";
import type { Proxy, Scene } from "../../state/scene-types";
import { scene } from "../../state/scene";
import {
  fetchHistogram,
  fetchJointHistogram,
  volume,
  type Histogram,
  type JointHistogram,
  type VolumeFacts,
} from "../../state/volume";

/** What the values of a volume that rules read are. */
export interface Domain {
  span: Span;
  histogram: Histogram | null;
  unit: string;
  /** Labels: whole numbers that are never interpolated. */
  discrete: boolean;
}

/** Names of what rules may read, with what a list shows for them. */
export function ruleVolumes(of: Scene): { name: string; title: string; discrete: boolean }[] {
  return [
    { name: "data", title: "The data", discrete: false },
    ...of.proxies.map((proxy) => ({ name: proxy.name, title: proxy.name, discrete: proxy.lookup === "nearest" })),
    ...(of.transfer.points.length ? [{ name: "opacity", title: "Opacity of the curve", discrete: false }] : []),
  ];
}

function widened({ lo, hi }: Span): Span {
  return hi > lo ? { lo, hi } : { lo: lo - 0.5, hi: lo + 0.5 };
}

function domainOf(name: string, facts: VolumeFacts | null, proxies: readonly Proxy[]): Domain {
  const data = { span: widened(facts?.histogram ?? { lo: 0, hi: 1 }), histogram: facts?.histogram ?? null };
  const unit = facts?.hounsfield ? "HU" : "";
  if (name === "data") return { ...data, unit, discrete: false };
  if (name === "opacity") return { span: { lo: 0, hi: 1 }, histogram: null, unit: "", discrete: false };
  const proxy = proxies.find((one) => one.name === name);
  if (proxy?.kind === "smoothed") return { ...data, unit, discrete: false };
  if (proxy?.kind === "distance") {
    const [lower, upper] = facts?.bounds_mm ?? [
      [0, 0, 0],
      [100, 100, 100],
    ];
    const quarter = Math.max(...upper.map((x, i) => x - lower[i]!)) / 4;
    return { span: { lo: -quarter, hi: quarter }, histogram: null, unit: "mm", discrete: false };
  }
  return { span: { lo: 0, hi: 1 }, histogram: null, unit: "", discrete: proxy?.lookup === "nearest" };
}

/** The values of a volume by its name in rules; those of files and gradients are asked of the server. */
export function useDomain(name: string): Domain {
  const facts = volume.value;
  const proxies = scene.value?.proxies ?? [];
  const proxy = proxies.find((one) => one.name === name);
  const [fetched, setFetched] = useState<{ key: string; histogram: Histogram } | null>(null);
  const asks = proxy && (proxy.kind === "file" || proxy.kind === "gradient");
  const key = asks ? `${facts?.name} ${JSON.stringify(proxy)}` : "";
  useEffect(() => {
    if (!key) return;
    let wanted = true;
    fetchHistogram(name)
      .then((histogram) => wanted && setFetched({ key, histogram }))
      .catch(() => {
        // Without a histogram the axis is that of unknown data; the curve can still be edited.
      });
    return () => void (wanted = false);
  }, [key]);
  const domain = domainOf(name, facts, proxies);
  if (!key || fetched?.key !== key) return domain;
  return { ...domain, span: widened(fetched.histogram), histogram: fetched.histogram };
}

/** The values of a volume, asked of the server where it has to be. */
export async function spanOf(name: string): Promise<Span> {
  const proxies = scene.peek()?.proxies ?? [];
  const kind = proxies.find((one) => one.name === name)?.kind;
  if (kind !== "file" && kind !== "gradient") return domainOf(name, volume.peek(), proxies).span;
  return fetchHistogram(name).then(widened, () => ({ lo: 0, hi: 1 }));
}

/** The joint histogram of two volumes by their names in rules; null until it is there, and where there is none. */
export function useJointHistogram(x: string, y: string): JointHistogram | null {
  const proxies = scene.value?.proxies ?? [];
  const known = (name: string) => name === "data" || proxies.some((proxy) => proxy.name === name);
  const [fetched, setFetched] = useState<{ key: string; histogram: JointHistogram } | null>(null);
  const key = known(x) && known(y) ? JSON.stringify([volume.value?.name, x, y, proxies]) : "";
  useEffect(() => {
    if (!key) return;
    let wanted = true;
    fetchJointHistogram(x, y)
      .then((histogram) => wanted && setFetched({ key, histogram }))
      .catch(() => {
        // The plane can be edited without.
      });
    return () => void (wanted = false);
  }, [key]);
  return key && fetched?.key === key ? fetched.histogram : null;
}
