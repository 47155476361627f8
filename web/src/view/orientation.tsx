import { directions, orientationLabel } from "../geometry/orientation";
import { dot, scale, type Vec3 } from "../geometry/vec3";
import type { FrameCamera } from "../state/protocol";
import { axisViews, lookFrom, orbitByPixels } from "./camera-control";
import { newGesture } from "../state/scene";
import { startDrag } from "../ui/drag";
import { view } from "./overlay";

/** Where the patient's sides are: letters at the picture's edges, and a cube. */

/** What the tools cover of a view at its left edge [CSS px]. */
const kTools = { width: 50, height: 255 };

export function EdgeLabels() {
  const shown = view.value;
  if (!shown) return null;
  const { camera, rect } = shown;
  const inset = 14;
  const leftInset = rect.x < kTools.width && rect.y + rect.height / 2 < kTools.height ? kTools.width + inset - rect.x : inset;
  const across = rect.x + rect.width / 2;
  const middle = rect.y + rect.height / 2;
  const places: [Vec3, number, number][] = [
    [camera.right, rect.x + rect.width - inset, middle],
    [scale(camera.right, -1), rect.x + leftInset, middle],
    [camera.up, across, rect.y + inset],
    [scale(camera.up, -1), across, rect.y + rect.height - inset],
  ];
  return (
    <g class="edge-labels" aria-hidden="true">
      {places.map(([direction, x, y], i) => (
        <text key={i} x={x} y={y}>
          {orientationLabel(direction).slice(0, 2)}
        </text>
      ))}
    </g>
  );
}

const kCube_px = 27;

/** The face of `vector` as the camera sees it: "right" and "up" of its letter, chosen so that it can be read. */
function faceAxes(vector: Vec3): { right: Vec3; up: Vec3 } {
  const up: Vec3 = vector[2] === 0 ? [0, 0, 1] : [0, vector[2] > 0 ? 1 : -1, 0];
  const right: Vec3 = [
    up[1] * vector[2] - up[2] * vector[1],
    up[2] * vector[0] - up[0] * vector[2],
    up[0] * vector[1] - up[1] * vector[0],
  ];
  return { right, up };
}

function Face({ camera, letter, name, vector }: { camera: FrameCamera } & (typeof directions)[number]) {
  const facing = -dot(vector, camera.forward);
  if (facing <= 0.02) return null;
  const onScreen = (v: Vec3) => [kCube_px * dot(v, camera.right), -kCube_px * dot(v, camera.up)] as const;
  const { right, up } = faceAxes(vector);
  const [mx, my] = onScreen(vector);
  const [rx, ry] = onScreen(right);
  const [ux, uy] = onScreen(up);
  const corners = [
    [1, 1],
    [-1, 1],
    [-1, -1],
    [1, -1],
  ] as const;
  const views = axisViews.find((one) => one.letter === letter)!;
  const look = () => lookFrom(views.azimuth_deg, views.elevation_deg);
  return (
    <g class="cube-face" role="button" tabindex={-1} aria-label={`View from ${name}`} onClick={look}>
      <polygon
        points={corners.map(([a, b]) => `${mx + a * rx + b * ux},${my + a * ry + b * uy}`).join(" ")}
        style={{ "--facing": facing }}
      />
      <text transform={`matrix(${rx / kCube_px} ${ry / kCube_px} ${-ux / kCube_px} ${-uy / kCube_px} ${mx} ${my})`}>
        {letter}
      </text>
    </g>
  );
}

/** Turns with the camera; a click on a face looks at it, a drag orbits. */
export function OrientationCube() {
  const camera = view.value?.camera;
  if (!camera) return null;
  const press = (event: PointerEvent) => {
    const gesture = newGesture("cube");
    let travelled = 0;
    const pressed = (event.target as Element).closest(".cube-face");
    startDrag(event, {
      move: (drag) => {
        travelled += Math.hypot(drag.stepX, drag.stepY);
        if (travelled > 4) orbitByPixels(drag.stepX * 2, drag.stepY * 2, gesture);
      },
      end: () => {
        // The capture hands the click to the cube as a whole.
        if (travelled <= 4) pressed?.dispatchEvent(new MouseEvent("click"));
      },
    });
  };
  return (
    <div class="orientation floating">
      <svg class="cube" width="104" height="104" viewBox="-52 -52 104 104" onPointerDown={press} aria-hidden="true">
        {directions.map((direction) => (
          <Face key={direction.letter} camera={camera} {...direction} />
        ))}
      </svg>
      <div class="axis-views" role="group" aria-label="Views along the patient's axes">
        {axisViews.map((one, i) => (
          <button
            key={one.letter}
            type="button"
            title={`${one.name} (${i + 1})`}
            aria-label={one.name}
            onClick={() => lookFrom(one.azimuth_deg, one.elevation_deg)}
          >
            {one.letter}
          </button>
        ))}
      </div>
    </div>
  );
}
