import { useEffect, useMemo, useState } from "preact/hooks";
import { newestWins } from "../model/latest";
import { volume } from "../state/volume";
import { fetchSlice, type Slice } from "./fetch-slice";

/** A slice of the data at `mm` with the labels there. */
export interface Shown {
  mm: number;
  data: Slice;
  labels: Slice | null;
}

/** Asks for the slice at `mm`, one request at a time, and keeps the last one until the next is there. */
export function useSlice(axis: "x" | "y" | "z", mm: number, overlay: string): { shown: Shown | null; failure: string } {
  const [shown, setShown] = useState<Shown | null>(null);
  const [failure, setFailure] = useState("");
  const requests = useMemo(
    () =>
      newestWins<{ mm: number; overlay: string }>(
        async (request, signal) => {
          const [data, of] = await Promise.all([
            fetchSlice(axis, request.mm, "", signal),
            request.overlay ? fetchSlice(axis, request.mm, request.overlay, signal).catch(() => null) : null,
          ]);
          setShown({ mm: request.mm, data, labels: of });
          setFailure("");
        },
        (error) => setFailure((error as Error).message),
      ),
    [axis],
  );
  const name = volume.value?.name;
  useEffect(() => requests.ask({ mm, overlay }), [requests, mm, overlay, name]);
  useEffect(() => () => requests.stop(), [requests]);
  return { shown, failure };
}
