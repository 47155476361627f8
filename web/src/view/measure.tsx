import { computed, signal } from "@preact/signals";
import { distance, type Vec3 } from "../geometry/vec3";
import { pointerTool } from "../state/tools";
import { on } from "../state/connection";
import { Icon } from "../ui/icons";
import { startDrag } from "../ui/drag";
import { showToast } from "../ui/toast";
import { view, type ViewProjection } from "./overlay";
import { pointed, probeAt } from "./probing";

/** Distances between points of the anatomy. They belong to this page, not to the scene. */

export interface Measurement {
  id: number;
  a: Vec3;
  b: Vec3;
}

export const measurements = signal<readonly Measurement[]>([]);
/** The first end of a distance whose second is not set yet. */
const begun = signal<Vec3 | null>(null);
export const measuring = computed(() => pointerTool.value === "measure");
let count = 0;

/** Distances belong to a volume; one that fails to open changes nothing. */
let opening = false;
on("status", (message) => {
  if (opening && message.stage === "ready") clearMeasurements();
  opening = message.stage === "reading" || message.stage === "preparing";
});

export function clearMeasurements(): void {
  measurements.value = [];
  begun.value = null;
}

export function removeMeasurement(id: number): void {
  measurements.value = measurements.value.filter((one) => one.id !== id);
}

/** Drops the first end, or the newest distance. */
export function removeLast(): void {
  if (begun.value) begun.value = null;
  else measurements.value = measurements.value.slice(0, -1);
}

/** Ends the tool, or first the distance that is begun. */
export function cancelMeasuring(): void {
  if (begun.value) begun.value = null;
  else pointerTool.value = "navigate";
}

/** A click of the tool at a place of the view area. */
export async function setEnd(x: number, y: number): Promise<void> {
  const place = (await probeAt({ x, y }))?.position_mm;
  if (!place) return showToast({ text: "Nothing there to measure: click on the volume." });
  if (!begun.value) {
    begun.value = place;
    return;
  }
  measurements.value = [...measurements.value, { id: ++count, a: begun.value, b: place }];
  begun.value = null;
}

async function moveEnd(id: number, end: "a" | "b", x: number, y: number): Promise<void> {
  const place = (await probeAt({ x, y }))?.position_mm;
  if (place) measurements.value = measurements.value.map((one) => (one.id === id ? { ...one, [end]: place } : one));
}

const formatted = (mm: number) => `${mm >= 100 ? mm.toFixed(0) : mm.toFixed(1)} mm`;

function Line({
  shown,
  a,
  b,
  children,
}: {
  shown: ViewProjection;
  a: Vec3;
  b: Vec3;
  children?: preact.ComponentChildren;
}) {
  const p = shown.project(a);
  const q = shown.project(b);
  if (p.depth_mm <= 0 || q.depth_mm <= 0) return null;
  const text = formatted(distance(a, b));
  const width = text.length * 6.6 + 14;
  return (
    <>
      <line class="under" x1={p.x} y1={p.y} x2={q.x} y2={q.y} />
      <line x1={p.x} y1={p.y} x2={q.x} y2={q.y} />
      <g transform={`translate(${(p.x + q.x) / 2} ${(p.y + q.y) / 2 - 16})`}>
        <rect class="tag" x={-width / 2} y={-10} width={width} height={20} rx={4} />
        <text class="tag-text">{text}</text>
        {children && <g transform={`translate(${width / 2 + 10} 0)`}>{children}</g>}
      </g>
    </>
  );
}

function End({ shown, of, end }: { shown: ViewProjection; of: Measurement; end: "a" | "b" }) {
  const p = shown.project(of[end]);
  if (p.depth_mm <= 0) return null;
  let busy = false;
  const press = (event: PointerEvent) => {
    const area = (event.currentTarget as Element).closest(".view")!.getBoundingClientRect();
    startDrag(event, {
      move: ({ event: at }) => {
        if (busy) return;
        busy = true;
        void moveEnd(of.id, end, at.clientX - area.left, at.clientY - area.top).finally(() => (busy = false));
      },
      end: ({ event: at }) => void moveEnd(of.id, end, at.clientX - area.left, at.clientY - area.top),
    });
  };
  return (
    <g class="handle end" transform={`translate(${p.x} ${p.y})`} onPointerDown={press}>
      <circle class="reach" r={12} />
      <circle class="dot" r={4} />
    </g>
  );
}

export function Measurements() {
  const shown = view.value;
  if (!shown) return null;
  const first = begun.value;
  const second = measuring.value ? pointed.value?.position_mm : undefined;
  const start = first && shown.project(first);
  const end = first && second && shown.project(second);
  return (
    <g class="measurements">
      {measurements.value.map((one) => (
        <g key={one.id} class="measurement">
          <Line shown={shown} a={one.a} b={one.b}>
            <g
              class="handle remove"
              role="button"
              tabindex={0}
              aria-label={`Delete the distance of ${formatted(distance(one.a, one.b))}`}
              onClick={() => removeMeasurement(one.id)}
              onKeyDown={(event) => (event.key === "Enter" || event.key === "Delete") && removeMeasurement(one.id)}
            >
              <circle class="tag" r={9} />
              <g transform="translate(-6 -6)">
                <Icon name="close" size={12} />
              </g>
            </g>
          </Line>
          <End shown={shown} of={one} end="a" />
          <End shown={shown} of={one} end="b" />
        </g>
      ))}
      {first && second && <Line shown={shown} a={first} b={second} />}
      {end && end.depth_mm > 0 && <circle class="dot" cx={end.x} cy={end.y} r={4} />}
      {start && start.depth_mm > 0 && <circle class="dot" cx={start.x} cy={start.y} r={4} />}
    </g>
  );
}
