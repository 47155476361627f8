import { canvasOf, planes, type PaneView, type Plane } from "../model/slice";
import { crosshair } from "../state/crosshair";
import type { MeasuringPane } from "../view/distances";
import { Distances } from "../view/measure";
import { ScaleMark } from "../view/scale-bar";

/** What is drawn over a slice. */
export function SliceMarks({ plane, pane, measured }: { plane: Plane; pane: PaneView; measured: MeasuringPane }) {
  const at = crosshair.value;
  if (!at || pane.width <= 1) return null;
  const [x, y] = canvasOf(planes[plane], pane, at);
  return (
    <svg class="overlay">
      <Crosshair x={x} y={y} pane={pane} plane={plane} />
      <ScaleMark x={16} y={pane.height - 12} pxPerMm={pane.pxPerMm} room_px={pane.width} where="in the slice" />
      <Distances pane={measured} />
    </svg>
  );
}

/** Lines in the colors of the planes that they are, open in the middle so that what is marked stays in sight. */
function Crosshair({ x, y, pane, plane }: { x: number; y: number; pane: PaneView; plane: Plane }) {
  const gap = 8;
  const vertical = plane === "sagittal" ? "coronal" : "sagittal";
  const horizontal = plane === "axial" ? "coronal" : "axial";
  return (
    <g class="slice-crosshair" aria-hidden="true">
      <path class={vertical} d={`M${x} 0V${y - gap}M${x} ${y + gap}V${pane.height}`} />
      <path class={horizontal} d={`M0 ${y}H${x - gap}M${x + gap} ${y}H${pane.width}`} />
    </g>
  );
}
