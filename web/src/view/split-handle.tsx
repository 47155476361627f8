import { section } from "../state/scene";
import { setSplit, split } from "../state/session";
import { startDrag } from "../ui/drag";
import { view } from "./overlay";

const render = section("render");

/** The line between the traced picture (left) and the denoised one (right); dragged sideways. */
export function SplitHandle() {
  const shown = view.value;
  const at = split.value;
  if (!shown || at === null) return null;
  const { rect } = shown;
  const x = rect.x + at * rect.width;
  const denoiser = render.value?.denoise ?? "none";
  const press = (event: PointerEvent) => {
    startDrag(event, {
      move: ({ dx }) => setSplit(Math.min(1, Math.max(0, at + dx / rect.width))),
    });
  };
  const keyDown = (event: KeyboardEvent) => {
    const by = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
    if (!by) return;
    event.preventDefault();
    event.stopPropagation();
    setSplit(Math.min(1, Math.max(0, at + by)));
  };
  return (
    <g
      class="handle split"
      role="slider"
      tabindex={0}
      aria-label="Split between traced and denoised picture"
      aria-valuenow={Math.round(at * 100)}
      aria-valuemin={0}
      aria-valuemax={100}
      onPointerDown={press}
      onKeyDown={keyDown}
    >
      <rect class="reach" x={x - 10} y={rect.y} width={20} height={rect.height} />
      <line class="under" x1={x} y1={rect.y} x2={x} y2={rect.y + rect.height} />
      <line x1={x} y1={rect.y} x2={x} y2={rect.y + rect.height} />
      <g transform={`translate(${x} ${rect.y + rect.height / 2})`}>
        <circle class="knob" r={13} />
        <path d="M-3.5 -4l-4 4 4 4M3.5 -4l4 4 -4 4" />
      </g>
      <text class="split-text left" x={x - 12} y={rect.y + rect.height - 40}>
        Traced
      </text>
      <text class="split-text" x={x + 12} y={rect.y + rect.height - 40}>
        {denoiser === "none" ? "No denoiser chosen" : `Denoised: ${denoiser}`}
      </text>
    </g>
  );
}
