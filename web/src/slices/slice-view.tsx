import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { formatCoordinate } from "../geometry/orientation";
import { newestWins } from "../model/latest";
import { canvasOf, fitSlice, planes, pointOf, type Plane } from "../model/slice";
import { dragWindow } from "../model/window";
import { crosshair, setCrosshair } from "../state/crosshair";
import type { Vec3 } from "../state/scene-types";
import { labelColors } from "../state/label-colors";
import { volume } from "../state/volume";
import { startDrag } from "../ui/drag";
import { pointAt } from "../view/probing";
import { fetchSlice, type Slice } from "./fetch-slice";
import { paintGrey, paintLabels } from "./paint";
import { dragTool, overlayOpacity, setWindow, sliceWindow } from "./state";

/** A slice of the data at `mm` with the labels there. */
interface Shown {
  mm: number;
  data: Slice;
  labels: Slice | null;
}

/** Asks for the slice at `mm`, one request at a time, and keeps the last one until the next is there. */
function useSlice(axis: "x" | "y" | "z", mm: number, overlay: string): { shown: Shown | null; failure: string } {
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

/** One plane with the crosshair: wheel, keys and slider go through it, clicks move the crosshair. */
export function SliceView({ plane, overlay }: { plane: Plane; overlay: string }) {
  const layout = planes[plane];
  const root = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [size, setSize] = useState({ width: 1, height: 1 });
  const facts = volume.value;
  const at = crosshair.value;
  const mm = at?.[layout.normal] ?? 0;
  const { shown, failure } = useSlice(layout.axis, mm, overlay);
  const window = sliceWindow.value;

  useEffect(() => {
    const observer = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      setSize({ width: Math.max(1, width), height: Math.max(1, height) });
    });
    observer.observe(root.current!);
    return () => observer.disconnect();
  }, []);

  const grey = useMemo(() => shown && bitmapOf(paintGrey(shown.data, window)), [shown?.data, window]);
  const colors = labelColors.value[overlay];
  const tint = useMemo(
    () => (shown?.labels && colors ? bitmapOf(paintLabels(shown.labels, colors)) : null),
    [shown?.labels, colors],
  );
  const header = shown?.data.header;
  const placement = header && fitSlice(header, size.width, size.height);

  useEffect(() => {
    const element = canvas.current!;
    const density = Math.min(devicePixelRatio, 2);
    element.width = Math.round(size.width * density);
    element.height = Math.round(size.height * density);
    const context = element.getContext("2d")!;
    context.scale(density, density);
    if (!header || !placement || !grey) return;
    if (layout.flipped) {
      context.translate(0, 2 * placement.top + placement.zoom * header.height);
      context.scale(1, -1);
    }
    const draw = (bitmap: HTMLCanvasElement) =>
      context.drawImage(
        bitmap,
        placement.left,
        placement.top,
        placement.zoom * header.width,
        placement.zoom * header.height,
      );
    context.imageSmoothingQuality = "high";
    draw(grey);
    if (tint) {
      context.imageSmoothingEnabled = false;
      context.globalAlpha = overlayOpacity.value;
      draw(tint);
    }
  }, [grey, tint, size, overlayOpacity.value]);

  if (!facts) return <div ref={root} class="slice" style={{ gridArea: plane }} />;
  const lo = facts.bounds_mm[0][layout.normal];
  const hi = facts.bounds_mm[1][layout.normal];
  const step = Math.min(...facts.spacing_mm);
  const moveTo = (value: number) => {
    const now = crosshair.peek();
    if (now) setCrosshair(now.map((x, i) => (i === layout.normal ? value : x)) as unknown as Vec3);
  };
  const pointAtEvent = (event: MouseEvent): Vec3 | null => {
    if (!header || !placement) return null;
    const box = root.current!.getBoundingClientRect();
    return pointOf(layout, header, placement, mm, event.clientX - box.left, event.clientY - box.top);
  };
  const down = (event: PointerEvent) => {
    if (event.button === 2 || (event.button === 0 && dragTool.value === "window")) {
      const from = window;
      startDrag(
        event,
        { move: ({ dx, dy }) => setWindow(dragWindow(from, dx, dy, facts.range[1] - facts.range[0])) },
        [0, 2],
      );
      return;
    }
    const first = pointAtEvent(event);
    if (event.button !== 0 || !first) return;
    setCrosshair(first);
    startDrag(event, {
      move: ({ event: moved }) => {
        const p = pointAtEvent(moved);
        if (p) setCrosshair(p);
      },
    });
  };
  const hover = (event: PointerEvent) => pointAt(event.buttons === 0 ? pointAtEvent(event) : null);
  const wheel = (event: WheelEvent) => {
    event.preventDefault();
    moveTo(mm - Math.sign(event.deltaY) * step * (event.shiftKey ? 10 : 1));
  };
  const keyDown = (event: KeyboardEvent) => {
    const steps = { ArrowUp: 1, ArrowDown: -1, PageUp: 10, PageDown: -10 }[event.key];
    if (!steps) return;
    event.preventDefault();
    event.stopPropagation();
    moveTo(mm + steps * step);
  };
  const cross = at && header && placement && canvasOf(layout, header, placement, at);
  const { letters } = layout;
  const place = `${formatCoordinate(layout.normal, mm)} mm`;
  return (
    <div
      ref={root}
      class={dragTool.value === "window" ? "slice windowing" : "slice"}
      style={{ gridArea: plane }}
      tabindex={0}
      role="group"
      aria-label={`${layout.title} slice at ${place}. Arrow keys go through the slices.`}
      onPointerDown={down}
      onPointerMove={hover}
      onPointerLeave={() => pointAt(null)}
      onWheel={wheel}
      onKeyDown={keyDown}
      onContextMenu={(event) => event.preventDefault()}
    >
      <canvas ref={canvas} />
      {cross && (
        <svg class="slice-marks" aria-hidden="true">
          <Crosshair x={cross[0]} y={cross[1]} width={size.width} height={size.height} plane={plane} />
        </svg>
      )}
      <span class="slice-letter left">{letters.left}</span>
      <span class="slice-letter right">{letters.right}</span>
      <span class="slice-letter top">{letters.top}</span>
      <span class="slice-letter bottom">{letters.bottom}</span>
      <span class={`slice-title ${plane}`}>{layout.title}</span>
      <span class="slice-readout">{place}</span>
      {failure && <span class="slice-failure">{failure}</span>}
      <input
        class="slice-slider"
        type="range"
        min={0}
        max={Math.max(1, Math.round((hi - lo) / step))}
        value={Math.round((mm - lo) / step)}
        aria-label={`${layout.title} slice`}
        aria-valuetext={place}
        onPointerDown={(event) => event.stopPropagation()}
        onInput={(event) => moveTo(lo + Number(event.currentTarget.value) * step)}
      />
    </div>
  );
}

function bitmapOf(image: ImageData): HTMLCanvasElement {
  const bitmap = document.createElement("canvas");
  bitmap.width = image.width;
  bitmap.height = image.height;
  bitmap.getContext("2d")!.putImageData(image, 0, 0);
  return bitmap;
}

/** Lines in the colors of the planes that they are, open in the middle so that what is marked stays in sight. */
function Crosshair(props: { x: number; y: number; width: number; height: number; plane: Plane }) {
  const { x, y, width, height, plane } = props;
  const gap = 8;
  const vertical = plane === "sagittal" ? "coronal" : "sagittal";
  const horizontal = plane === "axial" ? "coronal" : "axial";
  return (
    <>
      <path class={vertical} d={`M${x} 0V${y - gap}M${x} ${y + gap}V${height}`} />
      <path class={horizontal} d={`M0 ${y}H${x - gap}M${x + gap} ${y}H${width}`} />
    </>
  );
}
