import { useEffect, useMemo, useRef, useState } from "preact/hooks";
import { formatCoordinate } from "../geometry/orientation";
import { planes, type Plane, type Size } from "../model/slice";
import { nearestPlane, planeAt_mm, sliceSteps } from "../model/slice-steps";
import { crosshair } from "../state/crosshair";
import { labelPaintings } from "../state/label-colors";
import { volume } from "../state/volume";
import { measuring } from "../view/distances";
import { pointAt } from "../view/probing";
import { fingersOnPane } from "./fingers";
import { goToSlice, sliceInput, slicePane } from "./slice-input";
import { SliceMarks } from "./slice-marks";
import { SlicePicture } from "./slice-picture";
import { dragTool, paneView, setPaneSize } from "./state";
import { useSlice } from "./use-slice";

/** How large the pane is. */
function usePaneSize(plane: Plane, root: { current: HTMLDivElement | null }): Size {
  const [size, setSize] = useState<Size>({ width: 1, height: 1 });
  useEffect(() => {
    const observer = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      const now = { width: Math.max(1, width), height: Math.max(1, height) };
      setSize(now);
      setPaneSize(plane, now);
    });
    observer.observe(root.current!);
    return () => {
      observer.disconnect();
      setPaneSize(plane, null);
    };
  }, [plane]);
  return size;
}

const sliceKeys = "Arrow keys go through the slices, plus and minus zoom.";
const measuringKeys =
  "Arrow keys move the cursor, Enter sets an end of a distance, Page Up and Down go through the slices.";

/** One plane with the crosshair: wheel, keys and slider go through it, clicks move the crosshair. */
export function SliceView({ plane, overlay }: { plane: Plane; overlay: string }) {
  const layout = planes[plane];
  const root = useRef<HTMLDivElement>(null);
  const pane = paneView(usePaneSize(plane, root));
  const facts = volume.value;
  const mm = crosshair.value?.[layout.normal] ?? 0;
  const fingers = useMemo(fingersOnPane, []);
  const { shown, failure } = useSlice(layout.axis, mm, overlay, labelPaintings.value[overlay]?.beside ?? []);
  if (!facts) return <div ref={root} class="slice" style={{ gridArea: plane }} />;
  const steps = sliceSteps(facts, layout.normal);
  const input = sliceInput(plane, pane, mm, facts, fingers);
  const { letters } = layout;
  const place = `${formatCoordinate(layout.normal, mm)} mm`;
  return (
    <div
      ref={root}
      class={`slice ${dragTool.value === "window" ? "windowing" : ""} ${measuring.value ? "measuring" : ""}`}
      style={{ gridArea: plane }}
      tabindex={0}
      role="application"
      aria-label={`${layout.title} slice at ${place}. ${measuring.value ? measuringKeys : sliceKeys}`}
      onPointerDown={input.down}
      onPointerMove={input.move}
      onPointerUp={input.up}
      onPointerCancel={fingers.up}
      onPointerLeave={() => pointAt(null)}
      onWheel={input.wheel}
      onKeyDown={input.keyDown}
      onContextMenu={(event) => event.preventDefault()}
    >
      <SlicePicture layout={layout} pane={pane} shown={shown} overlay={overlay} />
      <SliceMarks plane={plane} pane={pane} measured={slicePane(plane, pane, mm, facts)} />
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
        max={steps.count - 1}
        value={nearestPlane(steps, mm)}
        aria-label={`${layout.title} slice`}
        aria-valuetext={place}
        onPointerDown={(event) => event.stopPropagation()}
        onInput={(event) => goToSlice(layout, planeAt_mm(steps, Number(event.currentTarget.value)))}
      />
    </div>
  );
}
