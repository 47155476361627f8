import { formatPlace } from "../geometry/length";
import type { Axis } from "../geometry/orientation";
import { nearestOnLine } from "../geometry/projection";
import { add, dot, scale, type Vec3 } from "../geometry/vec3";
import type { Clip, Faces } from "../state/scene-types";
import { lengthScale } from "../state/lengths";
import { edit, newGesture, scene, section } from "../state/scene";
import { volume } from "../state/volume";
import { clipHandles } from "../state/tools";
import { startDrag } from "../ui/drag";
import { visibleBox_mm } from "./camera-control";
import { view, type ViewProjection } from "./overlay";

/** The clip box over the picture, with a handle on each face that moves along the face's axis. */

const clip = section("clip");
/** The box keeps at least this share of the volume's side. */
const kThinnest = 0.01;
const fields = ["x_mm", "y_mm", "z_mm"] as const;
const open: Faces = [null, null];
const sideNames = [
  ["right", "left"],
  ["front", "back"],
  ["feet", "head"],
] as const;

/** Moves a face; beyond the volume, or without a place, it is open again. */
function setSide(axis: number, side: 0 | 1, mm: number | null, gesture: string): void {
  const bounds = volume.peek()?.bounds_mm;
  if (!bounds) return;
  const low = bounds[0][axis]!;
  const high = bounds[1][axis]!;
  const before: Clip = clip.peek() ?? { x_mm: open, y_mm: open, z_mm: open, blocks_light: false };
  const field = fields[axis]!;
  const [from, to] = before[field];
  const thin = kThinnest * (high - low);
  const range: Faces =
    side === 0
      ? [mm === null || mm <= low ? null : Math.min(mm, Math.min(to ?? high, high) - thin), to]
      : [from, mm === null || mm >= high ? null : Math.max(mm, Math.max(from ?? low, low) + thin)];
  if (clip.peek()) edit([[`/clip/${field}`, range]], gesture);
  else edit([["/clip", { ...before, [field]: range }]], gesture);
}

interface FaceProps {
  shown: ViewProjection;
  box: readonly [Vec3, Vec3];
  axis: Axis;
  side: 0 | 1;
}

function withAxis(v: Vec3, axis: number, value: number): Vec3 {
  return v.map((x, i) => (i === axis ? value : x)) as unknown as Vec3;
}

/** Handles of one axis are no nearer to one another [CSS px]. */
const kApart_px = 34;
/** Cosine to the view beyond which an axis has no length on the screen to drag along. */
const kFacing = 0.985;

/** Where the handle of a face is: in its middle, and beside it where the other face's would be in the same place. */
function handlePlace({ shown, box, axis, side }: FaceProps): { x: number; y: number; depth_mm: number } {
  const middle = scale(add(box[0], box[1]), 0.5);
  const [here, other] = [side, 1 - side].map((s) => shown.project(withAxis(middle, axis, box[s]![axis]!)));
  const [dx, dy] = [here!.x - other!.x, here!.y - other!.y];
  const apart = Math.hypot(dx, dy);
  if (apart >= kApart_px || other!.depth_mm <= 0) return here!;
  const [x, y] = apart > 1 ? [dx / apart, dy / apart] : [side === 0 ? -1 : 1, 0];
  const between = (a: number, b: number, way: number) => (a + b + kApart_px * way) / 2;
  return { ...here!, x: between(here!.x, other!.x, x), y: between(here!.y, other!.y, y) };
}

function Face(face: FaceProps) {
  const { shown, box, axis, side } = face;
  const at = box[side][axis]!;
  const middle = withAxis(scale(add(box[0], box[1]), 0.5), axis, at);
  const unit = withAxis([0, 0, 0], axis, 1);
  const seen = handlePlace(face);
  if (seen.depth_mm <= 0) return null;
  const [u, v] = [0, 1, 2].filter((other) => other !== axis) as [number, number];
  const corners = (
    [
      [0, 0],
      [1, 0],
      [1, 1],
      [0, 1],
    ] as const
  ).map(([a, b]) => shown.project(withAxis(withAxis(middle, u, box[a][u]!), v, box[b][v]!)));
  const cut = (clip.value?.[fields[axis]!][side] ?? null) !== null;
  const press = (event: PointerEvent) => {
    const area = (event.currentTarget as Element).closest(".view")!.getBoundingClientRect();
    const gesture = newGesture("clip");
    const facing = dot(unit, shown.ray(seen.x, seen.y).direction);
    // Along the view, up is away from the eye.
    const along = (e: PointerEvent) =>
      Math.abs(facing) > kFacing
        ? (-Math.sign(facing) * e.clientY) / shown.pxPerMm(seen.depth_mm)
        : nearestOnLine(middle, unit, (view.peek() ?? shown).ray(e.clientX - area.left, e.clientY - area.top));
    const grabbed = along(event) ?? 0;
    startDrag(event, {
      move: ({ event: e }) => {
        const now = along(e);
        if (now !== null) setSide(axis, side, at + now - grabbed, gesture);
      },
    });
  };
  const keyDown = (event: KeyboardEvent) => {
    const way = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    event.stopPropagation();
    const bounds = volume.peek()!.bounds_mm;
    setSide(axis, side, at + way * 0.01 * (bounds[1][axis]! - bounds[0][axis]!), newGesture("clip-keys"));
  };
  const name = sideNames[axis]![side];
  const place = formatPlace(axis, at, lengthScale.value);
  return (
    <g class={`clip-face axis-${axis}${cut ? " cut" : ""}`}>
      {corners.every((corner) => corner.depth_mm > 0) && (
        <polygon points={corners.map(({ x, y }) => `${x},${y}`).join(" ")} />
      )}
      <g
        class="handle"
        role="slider"
        tabindex={0}
        aria-label={`Clip from the ${name}`}
        aria-valuenow={Number(at.toPrecision(6))}
        aria-valuetext={place}
        transform={`translate(${seen.x} ${seen.y})`}
        onPointerDown={press}
        onKeyDown={keyDown}
        onDblClick={() => setSide(axis, side, null, newGesture("clip"))}
      >
        <title>{`Clip from the ${name}: ${place}. Double click opens it`}</title>
        <circle class="reach" r={16} />
        <circle class="knob" r={6.5} />
      </g>
    </g>
  );
}

function Edges({ shown, box }: { shown: ViewProjection; box: readonly [Vec3, Vec3] }) {
  const corner = (bits: number): Vec3 => [box[bits & 1]![0], box[(bits >> 1) & 1]![1], box[(bits >> 2) & 1]![2]];
  const seen = Array.from({ length: 8 }, (_, bits) => shown.project(corner(bits)));
  const lines = seen.flatMap((from, bits) =>
    [1, 2, 4].filter((bit) => !(bits & bit)).map((bit) => [from, seen[bits | bit]!] as const),
  );
  return (
    <g class="box-edges">
      {lines.map(([a, b], i) =>
        a.depth_mm > 0 && b.depth_mm > 0 ? <line key={i} x1={a.x} y1={a.y} x2={b.x} y2={b.y} /> : null,
      )}
    </g>
  );
}

export function ClipHandles() {
  const shown = view.value;
  const now = scene.value;
  if (!clipHandles.value || !shown || !now || !volume.value) return null;
  const box = visibleBox_mm(now);
  const faces = ([0, 1, 2] as const).flatMap((axis) => [0, 1].map((side) => ({ axis, side: side as 0 | 1 })));
  return (
    <g class="clip">
      <Edges shown={shown} box={box} />
      {faces.map((face) => (
        <Face key={`${face.axis}${face.side}`} shown={shown} box={box} {...face} />
      ))}
    </g>
  );
}
