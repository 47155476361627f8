import type { ComponentChildren } from "preact";
import { Icon } from "../ui/icons";
import { startDrag, type Drag } from "../ui/drag";
import type { Vec3 } from "../geometry/vec3";
import {
  begun,
  lengthOf,
  measurements,
  measuring,
  moveEnd,
  removeMeasurement,
  said,
  setEnd,
  stepEnd,
  type Measurement,
  type MeasuringPane,
} from "./distances";
import { cursorStep, keyCursor } from "./key-cursor";
import { view, viewSize } from "./overlay";
import { pointed } from "./probing";

/** Distances as they are drawn over the picture and over the slices. */

/** The picture, as distances are set in it. */
export function picturePane(): MeasuringPane {
  const shown = view.value;
  const { width, height } = viewSize.value;
  return {
    name: "picture",
    width,
    height,
    start: { x: width / 2, y: height / 2 },
    place: (p) => {
      const seen = shown?.project(p);
      return seen && seen.depth_mm > 0 ? seen : null;
    },
    at: (x, y) => ({ x, y }),
    under: (x, y) => () => ({ x, y }),
  };
}

interface LineProps {
  pane: MeasuringPane;
  of: { a: Vec3; b: Vec3 };
  children?: ComponentChildren;
}

function Line({ pane, of, children }: LineProps) {
  const p = pane.place(of.a);
  const q = pane.place(of.b);
  if (!p || !q) return null;
  const text = lengthOf(of);
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

const removes = (event: KeyboardEvent) => event.key === "Delete" || event.key === "Backspace";

/** Removes the distance that the focused handle is of; its pane has the focus then. */
function removeAndLeave(handle: Element, of: Measurement): void {
  handle.closest<HTMLElement>(".view, .slice")?.focus({ preventScroll: true });
  removeMeasurement(of.id);
}

function End({ pane, of, end }: { pane: MeasuringPane; of: Measurement; end: "a" | "b" }) {
  const p = pane.place(of[end]);
  if (!p) return null;
  let busy = false;
  const press = (event: PointerEvent) => {
    const area = (event.currentTarget as Element).closest(".view, .slice")!.getBoundingClientRect();
    // Wherever the handle was taken, the end goes by what the pointer goes.
    const follow = ({ dx, dy }: Drag) => moveEnd(of.id, end, pane, p.x + dx, p.y + dy);
    startDrag(event, {
      move: (drag) => {
        if (busy) return;
        busy = true;
        void follow(drag).finally(() => (busy = false));
      },
      end: (drag) => void follow(drag),
      // Clicks are ends of new distances, here too.
      click: ({ event: at }) => {
        if (measuring.peek()) void setEnd(pane, at.clientX - area.left, at.clientY - area.top);
      },
    });
  };
  const keyDown = (event: KeyboardEvent) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = cursorStep(event.key, event.shiftKey);
    if (step) stepEnd(of.id, end, pane, step);
    else if (removes(event)) removeAndLeave(event.currentTarget as Element, of);
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <g
      class="handle end"
      role="button"
      aria-roledescription="movable end"
      tabindex={0}
      aria-label={`${end === "a" ? "First" : "Second"} end of the distance of ${lengthOf(of)}`}
      transform={`translate(${p.x} ${p.y})`}
      onPointerDown={press}
      onKeyDown={keyDown}
    >
      <title>Drag, or arrow keys (Shift: ten times as far); Delete removes the distance</title>
      <circle class="reach" r={12} />
      <circle class="dot" r={4} />
    </g>
  );
}

function Remove({ of }: { of: Measurement }) {
  const keyDown = (event: KeyboardEvent) => {
    if (event.key !== "Enter" && event.key !== " " && !removes(event)) return;
    event.preventDefault();
    event.stopPropagation();
    removeAndLeave(event.currentTarget as Element, of);
  };
  return (
    <g
      class="handle remove"
      role="button"
      tabindex={0}
      aria-label={`Delete the distance of ${lengthOf(of)}`}
      onClick={() => removeMeasurement(of.id)}
      onKeyDown={keyDown}
    >
      <circle class="tag" r={9} />
      <g transform="translate(-6 -6)">
        <Icon name="close" size={12} />
      </g>
    </g>
  );
}

function Dot({ pane, at }: { pane: MeasuringPane; at: Vec3 }) {
  const seen = pane.place(at);
  return seen && <circle class="dot" cx={seen.x} cy={seen.y} r={4} />;
}

/** The distances whose both ends are seen in a pane, and the one that is begun. */
export function Distances({ pane }: { pane: MeasuringPane }) {
  const first = begun.value;
  const second = measuring.value ? pointed.value?.position_mm : undefined;
  const cursor = keyCursor.value?.pane === pane.name ? keyCursor.value : null;
  return (
    <g class="measurements">
      {measurements.value
        .filter((one) => pane.place(one.a) && pane.place(one.b))
        .map((one) => (
          <g key={one.id} class="measurement">
            <Line pane={pane} of={one}>
              <Remove of={one} />
            </Line>
            <End pane={pane} of={one} end="a" />
            <End pane={pane} of={one} end="b" />
          </g>
        ))}
      {first && second && <Line pane={pane} of={{ a: first, b: second }} />}
      {first && second && <Dot pane={pane} at={second} />}
      {first && <Dot pane={pane} at={first} />}
      {cursor && <KeyCursor x={cursor.x} y={cursor.y} />}
    </g>
  );
}

function KeyCursor({ x, y }: { x: number; y: number }) {
  const cross = `M${x - 14} ${y}h9M${x + 5} ${y}h9M${x} ${y - 14}v9M${x} ${y + 5}v9`;
  return (
    <g class="key-cursor">
      <path class="under" d={cross} />
      <path d={cross} />
    </g>
  );
}

/** Over the picture. */
export function Measurements() {
  return view.value ? <Distances pane={picturePane()} /> : null;
}

/** What screen readers hear of measuring. */
export function MeasuringVoice() {
  return (
    <div class="unseen" role="status" aria-live="polite" aria-label="Measuring">
      {said.value}
    </div>
  );
}
