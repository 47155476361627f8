import { useEffect, useMemo, useState } from "preact/hooks";
import { newestWins } from "../model/latest";
import { section } from "../state/scene";
import { volume } from "../state/volume";
import { fetchSlice, type Slice } from "./fetch-slice";

const proxies = section("proxies");

/** A slice of the data at `mm` with the labels there. */
export interface Shown {
  mm: number;
  data: Slice;
  labels: Slice | null;
  /** By name, of the volumes whose values decide how the labels look. */
  beside: ReadonlyMap<string, Slice>;
}

/** Asks for the slice at `mm`, one request at a time, and keeps the last one until the next is there; with those of the
 * labels `overlay` and of the volumes `beside`. */
export function useSlice(axis: "x" | "y" | "z", mm: number, overlay: string, beside: readonly string[]): { shown: Shown | null; failure: string } {
  const [shown, setShown] = useState<Shown | null>(null);
  const [failure, setFailure] = useState("");
  const requests = useMemo(
    () =>
      newestWins<{ mm: number; overlay: string; beside: readonly string[] }>(
        async (request, signal) => {
          const tried = (name: string) => fetchSlice(axis, request.mm, name, signal).catch(() => null);
          const [data, labels, ...others] = await Promise.all([
            fetchSlice(axis, request.mm, "", signal),
            request.overlay ? tried(request.overlay) : null,
            ...request.beside.map((name) => tried(name === "data" ? "" : name)),
          ]);
          const there = request.beside.flatMap((name, i) => (others[i] ? [[name, others[i]] as const] : []));
          setShown({ mm: request.mm, data, labels, beside: new Map(there) });
          setFailure("");
        },
        (error) => setFailure((error as Error).message),
      ),
    [axis],
  );
  const name = volume.value?.name;
  useEffect(() => requests.ask({ mm, overlay, beside }), [requests, mm, overlay, beside.join("/"), name, proxies.value]);
  useEffect(() => () => requests.stop(), [requests]);
  return { shown, failure };
}
