import { useEffect, useMemo, useRef } from "preact/hooks";
import { slicePlace, type PaneView, type PlaneLayout } from "../model/slice";
import { labelPaintings } from "../state/label-colors";
import { paintGrey, paintLabels } from "./paint";
import { overlayOpacity, sliceWindow } from "./state";
import type { Shown } from "./use-slice";

export interface SlicePictureProps {
  layout: PlaneLayout;
  pane: PaneView;
  shown: Shown | null;
  /** The label volume laid over it. */
  overlay: string;
}

/** The data of a slice in grey, and its labels over it. */
export function SlicePicture({ layout, pane, shown, overlay }: SlicePictureProps) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const window = sliceWindow.value;
  const grey = useMemo(() => shown && bitmapOf(paintGrey(shown.data, window)), [shown?.data, window]);
  const painting = labelPaintings.value[overlay];
  const tint = useMemo(() => {
    if (!shown?.labels || !painting) return null;
    const { image, header } = paintLabels(shown.labels, painting, shown.beside);
    return { bitmap: bitmapOf(image), header };
  }, [shown, painting]);
  const { width, height, center_mm, pxPerMm } = pane;

  useEffect(() => {
    const element = canvas.current!;
    const density = Math.min(devicePixelRatio, 2);
    element.width = Math.round(width * density);
    element.height = Math.round(height * density);
    const context = element.getContext("2d")!;
    context.scale(density, density);
    if (!shown || !grey) return;
    context.imageSmoothingQuality = "high";
    drawSlice(context, grey, layout, slicePlace(layout, shown.data.header, pane));
    if (!tint) return;
    context.imageSmoothingEnabled = false;
    context.globalAlpha = overlayOpacity.value;
    drawSlice(context, tint.bitmap, layout, slicePlace(layout, tint.header, pane));
  }, [grey, tint, width, height, center_mm, pxPerMm, overlayOpacity.value]);
  return <canvas ref={canvas} />;
}

function drawSlice(
  context: CanvasRenderingContext2D,
  bitmap: HTMLCanvasElement,
  layout: PlaneLayout,
  { left, top, width, height }: ReturnType<typeof slicePlace>,
): void {
  context.save();
  if (layout.flipped) {
    context.translate(0, 2 * top + height);
    context.scale(1, -1);
  }
  context.drawImage(bitmap, left, top, width, height);
  context.restore();
}

function bitmapOf(image: ImageData): HTMLCanvasElement {
  const bitmap = document.createElement("canvas");
  bitmap.width = image.width;
  bitmap.height = image.height;
  bitmap.getContext("2d")!.putImageData(image, 0, 0);
  return bitmap;
}
