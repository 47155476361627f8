import { signal } from "@preact/signals";
import type { Probe } from "../state/protocol";
import { probeAt } from "./probing";

/** Whether the next click into the picture chooses a point. */
export const picking = signal(false);

let cancel: (() => void) | null = null;

/** Waits for a click into the picture and answers with what is there; null: nothing, Escape, or another pick began. */
export function pickPoint(): Promise<Probe | null> {
  cancel?.();
  const area = document.querySelector<HTMLElement>(".view");
  if (!area) return Promise.resolve(null);
  return new Promise((resolve) => {
    const stop = new AbortController();
    const end = (answer: Promise<Probe | null> | null) => {
      stop.abort();
      cancel = null;
      picking.value = false;
      resolve(answer);
    };
    cancel = () => end(null);
    picking.value = true;
    const options = { capture: true, signal: stop.signal };
    area.addEventListener(
      "pointerdown",
      (event) => {
        event.preventDefault();
        event.stopImmediatePropagation();
        const box = area.getBoundingClientRect();
        end(probeAt({ x: event.clientX - box.left, y: event.clientY - box.top }));
      },
      options,
    );
    window.addEventListener(
      "keydown",
      (event) => event.key === "Escape" && (event.stopPropagation(), end(null)),
      options,
    );
  });
}
