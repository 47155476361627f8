import { useRef } from "preact/hooks";
import { formatNumber, niceStep } from "../../model/axis";
import { clamp } from "../../model/curve";
import { deleteKeyframe, durationOf, keyframesOf, moveKeyframe, orStill, type Keyframe } from "../../model/keyframes";
import { edit, newGesture } from "../../state/scene";
import type { Scene } from "../../state/scene-types";
import { startDrag } from "../../ui/drag";
import { useWidth } from "../../ui/use-width";
import { playhead, seek } from "./playback";

const gutter = 76;
const ruler = 20;
const lane = 20;

/** The lanes of the strip: what a track's field begins with. */
const lanes: readonly { title: string; of: readonly string[] }[] = [
  { title: "Camera", of: ["/camera"] },
  { title: "Lights", of: ["/lights", "/environment", "/background"] },
  { title: "Transfer", of: ["/transfer", "/material", "/labels", "/image"] },
  { title: "Clip box", of: ["/clip"] },
];

const inLane = (of: readonly string[]) => (field: string) => of.some((start) => field.startsWith(`${start}/`));

/** Time to the right; a keyframe is a diamond, and a dot in the lane of all that it moves. */
export function KeyframeStrip({
  of,
  selected,
  onSelect,
}: {
  of: Scene;
  selected: number | null;
  onSelect(time: number | null): void;
}) {
  const frame = useRef<HTMLDivElement>(null);
  const root = useRef<SVGSVGElement>(null);
  const whole = useWidth(frame, 800);
  const width = Math.max(50, whole - gutter - 16);
  const keyGesture = useRef("");
  const { animation } = of;
  const keyframes = keyframesOf(animation);
  const fps = animation?.fps ?? 30;
  const end = Math.max(durationOf(animation), keyframes.at(-1)?.time ?? 0, 4) * 1.08;
  const x = (time: number) => gutter + (time / end) * width;
  const timeAt = (clientX: number) =>
    clamp(((clientX - root.current!.getBoundingClientRect().left - gutter) / width) * end, 0, end);
  const onFrame = (time: number) => Math.round(time * fps) / fps;
  const height = ruler + lane * (lanes.length + 1) + 4;

  const scrub = (event: PointerEvent) => {
    seek(onFrame(timeAt(event.clientX)));
    onSelect(null);
    startDrag(event, { move: ({ event: at }) => seek(onFrame(timeAt(at.clientX))) });
  };
  const drag = (event: PointerEvent, key: Keyframe) => {
    if (!animation) return;
    onSelect(key.time);
    const gesture = newGesture("keyframe");
    // All moves begin with the animation as it was, so that keys that are passed are not pushed away.
    startDrag(event, {
      move: ({ dx }) => {
        if (Math.abs(dx) < 2) return;
        const to = onFrame(clamp(key.time + (dx / width) * end, 0, 1e6));
        edit([["/animation", moveKeyframe(animation, key.time, to)]], gesture);
        onSelect(to);
      },
    });
  };
  const keyDown = (event: KeyboardEvent, key: Keyframe) => {
    if (!animation) return;
    const sideways = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (event.key === "Delete" || event.key === "Backspace") {
      edit([["/animation", orStill(deleteKeyframe(animation, key.time))]], newGesture("keyframe"));
      onSelect(null);
    } else if (sideways) {
      if (!event.repeat) keyGesture.current = newGesture("keyframe-key");
      const to = onFrame(Math.max(0, key.time + (sideways * (event.shiftKey ? 10 : 1)) / fps));
      edit([["/animation", moveKeyframe(animation, key.time, to)]], keyGesture.current);
      onSelect(to);
    } else if (event.key === "Enter" || event.key === " ") {
      seek(key.time);
      onSelect(key.time);
    } else {
      return;
    }
    event.preventDefault();
    event.stopPropagation();
  };

  const step = niceStep(end / Math.max(2, width / 80));
  const marks = Array.from({ length: Math.floor(end / step) + 1 }, (_, i) => i * step);
  const isSelected = (key: Keyframe) => selected !== null && Math.abs(key.time - selected) < 1e-4;
  return (
    <div ref={frame} class="keyframe-strip">
      <svg ref={root} width={whole} height={height} role="group" aria-label="Keyframes">
        <rect class="ruler" x={gutter - 6} y={0} width={width + 16} height={height} onPointerDown={scrub} />
        {marks.map((time) => (
          <g key={time} class="mark">
            <line x1={x(time)} x2={x(time)} y1={ruler - 5} y2={height} />
            <text x={x(time) + 3} y={11}>
              {formatNumber(time, step / 2)} s
            </text>
          </g>
        ))}
        {animation?.turntable && (
          <g class="turntable">
            <rect
              x={x(0)}
              y={ruler + lane + 3}
              width={Math.max(1, x(animation.turntable.seconds) - x(0))}
              height={lane - 6}
              rx={3}
            />
            <text x={x(0) + 14} y={ruler + lane + 14}>
              {animation.turntable.turns === 1 ? "Turntable" : `Turntable, ${animation.turntable.turns} turns`}
            </text>
          </g>
        )}
        <text class="lane" x={8} y={ruler + 14}>
          Keyframes
        </text>
        {lanes.map(({ title, of: starts }, i) => {
          const y = ruler + lane * (i + 1) + lane / 2;
          const mine = keyframes.filter((key) => key.fields.some(inLane(starts)));
          return (
            <g key={title} class={mine.length ? "lane used" : "lane"}>
              <text x={8} y={y + 4}>
                {title}
              </text>
              {mine.length > 1 && <line x1={x(mine[0]!.time)} x2={x(mine.at(-1)!.time)} y1={y} y2={y} />}
              {mine.map((key) => (
                <circle key={key.time} cx={x(key.time)} cy={y} r={3} />
              ))}
            </g>
          );
        })}
        <g class="playhead" transform={`translate(${x(Math.min(playhead.value, end))} 0)`}>
          <path d={`M-5 0h10v7l-5 5-5-5z`} />
          <line y1={10} y2={height} />
          <rect
            x={-8}
            y={0}
            width={16}
            height={ruler}
            tabindex={0}
            role="slider"
            aria-label="Time"
            aria-valuemin={0}
            aria-valuemax={end}
            aria-valuenow={playhead.value}
            aria-valuetext={`${playhead.value.toFixed(2)} s`}
            onPointerDown={scrub}
            onKeyDown={(event) => {
              const sideways = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
              if (!sideways) return;
              event.preventDefault();
              event.stopPropagation();
              seek(onFrame(Math.max(0, playhead.value + (sideways * (event.shiftKey ? 10 : 1)) / fps)));
            }}
          />
        </g>
        {keyframes.map((key, i) => (
          <path
            key={i}
            class={isSelected(key) ? "keyframe selected" : "keyframe"}
            d="M0 -7L7 0L0 7L-7 0Z"
            transform={`translate(${x(key.time)} ${ruler + lane / 2})`}
            tabindex={0}
            role="button"
            aria-pressed={isSelected(key)}
            aria-label={`Keyframe at ${key.time.toFixed(2)} seconds, ${key.fields.length} fields. Arrow keys move it, Delete removes it, Enter shows it.`}
            onFocus={() => onSelect(key.time)}
            onPointerDown={(event) => drag(event, key)}
            onDblClick={() => seek(key.time)}
            onKeyDown={(event) => keyDown(event, key)}
          >
            <title>{`${key.time.toFixed(2)} s\n${key.fields.join("\n")}`}</title>
          </path>
        ))}
      </svg>
    </div>
  );
}
