import { effect, signal } from "@preact/signals";
import { bottomPanel, sidePanel } from "../state/preferences";

/** Windows that have room for one panel at a time; as in styles/small.css. */
const query = matchMedia("(width <= 720px) or (height <= 480px)");

const small = signal(query.matches);
query.addEventListener("change", () => (small.value = query.matches));

/** Closes the other panel in a small window: the one that was open longer. */
export function keepOnePanel(): void {
  let before: string | null = null;
  effect(() => {
    const side = sidePanel.value;
    const bottom = bottomPanel.value;
    if (small.value && side !== null && bottom !== null) {
      if (bottom === before) bottomPanel.value = null;
      else sidePanel.value = null;
    }
    before = bottomPanel.peek();
  });
}
