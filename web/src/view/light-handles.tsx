import { useRef } from "preact/hooks";
import { linear, toHex } from "../color";
import {
  directionField,
  facedPoint,
  onSphere,
  positionField,
  rectCorners,
  worldDirection,
  worldPosition,
  type CameraFrame,
} from "../geometry/light-place";
import { add, dot, scale, sub, type Vec3 } from "../geometry/vec3";
import type { Light } from "../state/scene-types";
import { edit, newGesture, section } from "../state/scene";
import { lightHandles, selectedLight } from "../state/tools";
import { startDrag, type Drag } from "../ui/drag";
import { cameraNow } from "./camera-control";
import { view, viewSize, type ViewProjection } from "./overlay";

/** The lights over the picture. Directional ones are moved over a sphere around the target, others in the plane that
 * faces the camera; the wheel, and drags with Shift, change their distance from what they light. */

const lights = section("lights");

/** Of the sphere of directional lights, by the smaller side of the view. */
const kSphereShare = 0.38;
/** What handles keep from the view's edges: at the left the tools are, at the top what they want, in the upper right
 * corner the orientation cube. All of these lie over the handles. */
const kEdge_px = 22;
const kToolEdge_px = 66;
const kCubeCorner_px = 155;

function isFree(x: number, y: number): boolean {
  const { width, height } = viewSize.value;
  if (x < kToolEdge_px || y < kToolEdge_px || x > width - kEdge_px || y > height - kEdge_px) return false;
  return x < width - kCubeCorner_px || y > kCubeCorner_px;
}

interface Scenery {
  shown: ViewProjection;
  camera: CameraFrame;
  /** Where the target is seen [CSS px], and the radius of the sphere around it. */
  center: { x: number; y: number };
  radius_px: number;
  pxPerMm: number;
}

interface Place {
  x: number;
  y: number;
  /** On the far side of the sphere. */
  away: boolean;
  /** Where the light is seen; else it is outside the view or behind the eye, and shown at the view's edge. */
  exact: boolean;
}

function directionalPlace(light: Light, { camera, center, radius_px }: Scenery): Place {
  const to = worldDirection(light, camera);
  return {
    x: center.x + radius_px * dot(to, camera.right),
    y: center.y - radius_px * dot(to, camera.up),
    away: dot(to, camera.forward) > 1e-9,
    exact: true,
  };
}

/** Lights behind the eye, or just before it, are shown and moved by the scale of the target. */
function isSeen(depth_mm: number, { shown, camera }: Scenery): boolean {
  return depth_mm > 0.05 * Math.abs(shown.project(camera.target_mm).depth_mm);
}

function positionedPlace(light: Light, scenery: Scenery): Place {
  const { shown, camera, center, pxPerMm } = scenery;
  const position = worldPosition(light, camera);
  const seen = shown.project(position);
  if (isSeen(seen.depth_mm, scenery) && isFree(seen.x, seen.y))
    return { x: seen.x, y: seen.y, away: false, exact: true };
  // Outside, or behind the eye: at the view's edge, in its direction from the target.
  const offset = sub(position, camera.target_mm);
  const dx = dot(offset, camera.right) * pxPerMm;
  const dy = -dot(offset, camera.up) * pxPerMm;
  const { width, height } = viewSize.value;
  let share = Math.min(1, (width + height) / Math.max(1e-6, Math.hypot(dx, dy)));
  while (share > 0.01 && !isFree(center.x + dx * share, center.y + dy * share)) share *= 0.98;
  return { x: center.x + dx * share, y: center.y + dy * share, away: false, exact: false };
}

/** Sets the distance of a point or rect light from what it faces, `factor` times as far. */
function changeDistance(index: number, light: Light, camera: CameraFrame, factor: number, gesture: string): void {
  if (light.kind === "directional") return;
  const around = facedPoint(light, camera);
  const position = add(around, scale(sub(worldPosition(light, camera), around), factor));
  edit([[`/lights/${index}/position_mm`, positionField(light, position, camera)]], gesture);
}

function dragDirectional(index: number, light: Light, scenery: Scenery, start: Place, gesture: string) {
  const { center, radius_px, camera } = scenery;
  let front = !start.away;
  let outside = false;
  return ({ dx, dy }: Drag) => {
    const x = (start.x + dx - center.x) / radius_px;
    const y = -(start.y + dy - center.y) / radius_px;
    // Over the rim and back in: on the other side.
    if (Math.hypot(x, y) > 1) outside = true;
    else if (outside) {
      outside = false;
      front = !front;
    }
    const [right, up, toEye] = onSphere(x, y, front);
    const world = add(add(scale(camera.right, right), scale(camera.up, up)), scale(camera.forward, -toEye));
    edit([[`/lights/${index}/direction`, directionField(light, world, camera)]], gesture);
  };
}

function dragPositioned(index: number, light: Light, scenery: Scenery, start: Place, gesture: string) {
  const { shown, camera, center, pxPerMm } = scenery;
  const position = worldPosition(light, camera);
  const { depth_mm } = shown.project(position);
  const behind_mm = dot(sub(position, camera.target_mm), camera.forward);
  return ({ dx, dy, stepY, event }: Drag) => {
    if (event.shiftKey) {
      const now = lights.peek()?.[index];
      if (now) changeDistance(index, now, camera, Math.exp(-stepY * 0.008), gesture);
      return;
    }
    const x = start.x + dx;
    const y = start.y + dy;
    const inPlane = add(scale(camera.right, (x - center.x) / pxPerMm), scale(camera.up, (center.y - y) / pxPerMm));
    const moved = isSeen(depth_mm, scenery)
      ? shown.pointAtDepth(x, y, depth_mm)
      : add(camera.target_mm, add(inPlane, scale(camera.forward, behind_mm)));
    edit([[`/lights/${index}/position_mm`, positionField(light, moved, camera)]], gesture);
  };
}

function Handle({ index, light, scenery }: { index: number; light: Light; scenery: Scenery }) {
  const wheel = useRef({ gesture: "", time_ms: -Infinity });
  const { shown, camera, center } = scenery;
  const place = light.kind === "directional" ? directionalPlace(light, scenery) : positionedPlace(light, scenery);
  const chosen = selectedLight.value === index;
  const press = (event: PointerEvent) => {
    selectedLight.value = index;
    const gesture = newGesture("light");
    const drag = light.kind === "directional" ? dragDirectional : dragPositioned;
    startDrag(event, { move: drag(index, light, scenery, place, gesture) });
  };
  const turnWheel = (event: WheelEvent) => {
    event.preventDefault();
    event.stopPropagation();
    if (event.timeStamp - wheel.current.time_ms > 400) wheel.current.gesture = newGesture("light-distance");
    wheel.current.time_ms = event.timeStamp;
    changeDistance(index, light, camera, Math.exp(event.deltaY * 0.001), wheel.current.gesture);
  };
  const keyDown = (event: KeyboardEvent) => {
    const by = { ArrowLeft: [-8, 0], ArrowRight: [8, 0], ArrowUp: [0, -8], ArrowDown: [0, 8] }[event.key];
    if (!by) return;
    event.preventDefault();
    event.stopPropagation();
    const drag = light.kind === "directional" ? dragDirectional : dragPositioned;
    const fake = { dx: by[0]!, dy: by[1]!, stepX: by[0]!, stepY: by[1]!, event: event as unknown as PointerEvent };
    drag(index, light, scenery, place, newGesture("light-keys"))(fake);
  };
  const corners = light.kind === "rect" && place.exact ? rectCorners(light, camera).map(shown.project) : [];
  const strength = Math.max(...linear(light.color), 1e-6);
  const [r, g, b] = linear(light.color).map((c) => c / strength) as unknown as Vec3;
  const kindName = { directional: "Directional light", point: "Point light", rect: "Area light" }[light.kind];
  return (
    <g class={`light${chosen ? " chosen" : ""}${place.away ? " away" : ""}${place.exact ? "" : " beyond"}`}>
      <line class="beam" x1={place.x} y1={place.y} x2={center.x} y2={center.y} />
      {corners.length > 0 && corners.every((corner) => corner.depth_mm > 0) && (
        <polygon class="area" points={corners.map(({ x, y }) => `${x},${y}`).join(" ")} />
      )}
      <g
        class="handle"
        role="button"
        tabindex={0}
        aria-label={`${kindName} ${index + 1}`}
        transform={`translate(${place.x} ${place.y})`}
        onPointerDown={press}
        onWheel={turnWheel}
        onKeyDown={keyDown}
        onFocus={() => (selectedLight.value = index)}
      >
        <title>{`${kindName} ${index + 1}${light.kind === "directional" ? "" : ": wheel or Shift moves it nearer"}`}</title>
        <circle class="reach" r={18} />
        <circle class="glow" r={11} />
        <circle class="bulb" r={7} style={{ "--light": toHex({ linear: [r, g, b] }) }} />
        {light.kind === "directional" && (
          <path d="M0 -15v3M0 12v3M-15 0h3M12 0h3M-10.6 -10.6l2.1 2.1M8.5 8.5l2.1 2.1M10.6 -10.6l-2.1 2.1M-8.5 8.5l-2.1 2.1" />
        )}
        {light.kind === "rect" && <rect x={-12} y={-12} width={24} height={24} rx={2} />}
        {light.kind === "point" && <circle class="ring" r={13} />}
        <text class="number-text">{index + 1}</text>
      </g>
    </g>
  );
}

export function LightHandles() {
  const shown = view.value;
  const now = cameraNow();
  if (!lightHandles.value || !shown || !now || !lights.value) return null;
  // The axes of the picture on screen, so that the handles keep to it.
  const camera = { ...shown.camera, target_mm: now.target_mm };
  const target = shown.project(now.target_mm);
  if (target.depth_mm <= 0) return null;
  const scenery: Scenery = {
    shown,
    camera,
    center: target,
    radius_px: kSphereShare * Math.min(shown.rect.width, shown.rect.height),
    pxPerMm: shown.pxPerMm(target.depth_mm),
  };
  const sphere = lights.value.some((light) => light.kind === "directional");
  return (
    <g class="lights">
      {sphere && <circle class="sphere" cx={target.x} cy={target.y} r={scenery.radius_px} />}
      {lights.value.map((light, index) => (
        <Handle key={index} index={index} light={light} scenery={scenery} />
      ))}
    </g>
  );
}
