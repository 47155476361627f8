import { niceLength } from "../geometry/length";
import { cameraNow } from "./camera-control";
import { view } from "./overlay";

const kLongest_px = 150;

export interface ScaleMarkProps {
  /** Its left end [CSS px]. */
  x: number;
  y: number;
  pxPerMm: number;
  /** How wide what it stands in is [CSS px]. */
  room_px: number;
  /** Where the length holds. */
  where: string;
}

/** A length that is round, and its name. */
export function ScaleMark({ x, y, pxPerMm, room_px, where }: ScaleMarkProps) {
  const { mm, label } = niceLength(Math.min(kLongest_px, room_px / 3) / pxPerMm);
  const width = mm * pxPerMm;
  return (
    <g class="scale-bar">
      <title>{`${label} ${where}`}</title>
      <path class="under" d={`M${x} ${y - 5}v5h${width}v-5`} />
      <path d={`M${x} ${y - 5}v5h${width}v-5`} />
      <text x={x + width / 2} y={y - 7}>
        {label}
      </text>
    </g>
  );
}

/** A length in the plane of the target that faces the camera. */
export function ScaleBar() {
  const shown = view.value;
  const target = cameraNow()?.target_mm;
  if (!shown || !target) return null;
  const depth_mm = shown.project(target).depth_mm;
  if (depth_mm <= 0) return null;
  const { rect } = shown;
  return (
    <ScaleMark
      x={Math.max(16, rect.x + 16)}
      y={rect.y + rect.height - 18}
      pxPerMm={shown.pxPerMm(depth_mm)}
      room_px={rect.width}
      where="at the depth of the orbit's target"
    />
  );
}
