import { effect } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import { frame, frameShown } from "../state/frame";
import { letterbox, viewSize } from "./overlay";

/** The newest picture on a canvas over the view area, as large as fits; tells the server what was drawn. */
export function Picture() {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => {
    const context = canvas.current!.getContext("2d", { alpha: true })!;
    let request = 0;
    let drawn = 0;
    const draw = () => {
      request = 0;
      const { width, height } = viewSize.peek();
      const density = Math.min(devicePixelRatio, 2);
      const target = context.canvas;
      if (target.width !== Math.round(width * density)) target.width = Math.round(width * density);
      if (target.height !== Math.round(height * density)) target.height = Math.round(height * density);
      context.setTransform(density, 0, 0, density, 0, 0);
      context.clearRect(0, 0, width, height);
      const shown = frame.peek();
      if (!shown) return;
      const rect = letterbox(shown.header.full, { width, height });
      context.imageSmoothingQuality = "high";
      context.drawImage(shown.picture, rect.x, rect.y, rect.width, rect.height);
      if (drawn !== shown.header.frame) frameShown((drawn = shown.header.frame));
    };
    const stop = effect(() => {
      void frame.value;
      void viewSize.value;
      request ||= requestAnimationFrame(draw);
    });
    return () => {
      stop();
      cancelAnimationFrame(request);
    };
  }, []);
  return <canvas ref={canvas} class="picture" role="img" aria-label="The rendered volume" />;
}
