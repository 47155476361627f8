import { niceLength } from "../geometry/scale-bar";
import { cameraNow } from "./camera-control";
import { view } from "./overlay";

const kLongest_px = 150;

/** A length in the plane of the target that faces the camera. */
export function ScaleBar() {
  const shown = view.value;
  const target = cameraNow()?.target_mm;
  if (!shown || !target) return null;
  const depth_mm = shown.project(target).depth_mm;
  if (depth_mm <= 0) return null;
  const pxPerMm = shown.pxPerMm(depth_mm);
  const { mm, label } = niceLength(kLongest_px / pxPerMm);
  const width = mm * pxPerMm;
  const x = Math.max(16, shown.rect.x + 16);
  const y = shown.rect.y + shown.rect.height - 18;
  return (
    <g class="scale-bar">
      <title>{`${label} at the depth of the orbit's target`}</title>
      <path class="under" d={`M${x} ${y - 5}v5h${width}v-5`} />
      <path d={`M${x} ${y - 5}v5h${width}v-5`} />
      <text x={x + width / 2} y={y - 7}>
        {label}
      </text>
    </g>
  );
}
