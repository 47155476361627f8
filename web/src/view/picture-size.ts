import { computed, effect } from "@preact/signals";
import { link, on } from "../state/connection";
import { resolution } from "../state/preferences";
import { edit, scene } from "../state/scene";
import { viewSize } from "./overlay";

/** Keeps the picture as large as this page's view. Of several pages the one resized last decides, so a page that
 * another has overruled keeps quiet until it is resized itself. */

const kRest_ms = 200;
const kSmallest_px = 64;

/** The picture's size for this view. */
const wanted = computed(() => ({
  width: Math.max(kSmallest_px, Math.round(viewSize.value.width * resolution.value)),
  height: Math.max(kSmallest_px, Math.round(viewSize.value.height * resolution.value)),
}));

let decides = true;

function set(): void {
  const image = scene.peek()?.image;
  const { width, height } = wanted.peek();
  if (!image || viewSize.peek().width <= 1 || (image.width === width && image.height === height)) return;
  edit([
    ["/image/width", width],
    ["/image/height", height],
  ]);
}

/** Starts to follow the view; returns what ends that. */
export function followViewSize(): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  let known = wanted.peek();
  const stops = [
    effect(() => {
      const now = wanted.value;
      if (now.width === known.width && now.height === known.height) return;
      known = now;
      decides = true;
      clearTimeout(timer);
      timer = setTimeout(set, kRest_ms);
    }),
    effect(() => {
      if (link.value.kind !== "open") return;
      clearTimeout(timer);
      timer = setTimeout(set, kRest_ms);
    }),
    on("scene", () => decides && set()),
    on("edited", (message) => {
      if (message.seq !== undefined || !("image" in message.sections)) return;
      const image = message.sections.image as { width: number; height: number };
      const { width, height } = wanted.peek();
      if (image.width !== width || image.height !== height) decides = false;
    }),
  ];
  return () => {
    clearTimeout(timer);
    for (const stop of stops) stop();
  };
}
