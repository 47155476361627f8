import { dot, sub } from "../geometry/vec3";
import { wrapDegrees } from "../model/angles";
import { crosshair } from "../state/crosshair";
import { frame } from "../state/frame";
import { reachFactor } from "../state/lengths";
import { edit, newGesture, scene } from "../state/scene";
import type { Vec3 } from "../state/scene-types";
import { showToast } from "../ui/toast";
import { Button, Field, NumberInput, Section, Segmented } from "../ui/controls";
import { picking, pickPoint } from "../view/pick";
import { numberFields } from "./number-fields";

/** Name, range, unit and step of the camera's numbers. */
const CameraNumber = numberFields("/camera", {
  vertical_fov_deg: { label: "Field of view", hint: "Vertical", unit: "°", min: 5, max: 120, hardMin: 0.1, hardMax: 170, digits: 1, initial: 30 },
  zoom: { label: "Zoom", min: 0.1, max: 20, hardMin: 1e-4, hardMax: 1e6, logarithmic: true, digits: 3, initial: 1 },
  azimuth_deg: { label: "Azimuth", hint: "0 is in front of the patient, 90 at the patient's left", unit: "°", min: -180, max: 180, hardMin: -36000, hardMax: 36000, digits: 1, initial: 0 },
  elevation_deg: { label: "Elevation", unit: "°", min: -90, max: 90, digits: 1, initial: 0 },
  roll_deg: { label: "Roll", hint: "Clockwise turn of the camera; a double click on the word takes it back", unit: "°", min: -180, max: 180, digits: 1, initial: 0 },
  aperture_radius_mm: { label: "Aperture radius", hint: "0: all is sharp", unit: "mm", min: 0, max: 30, hardMax: 1e6, step: 0.1, digits: 2, initial: 0 },
  focus_mm: { label: "Focus distance", hint: "Of the sharp plane from the eye", unit: "mm", min: 1, max: 1000, hardMax: 1e9, digits: 1 },
});

/** How far a point is from the eye along the view. */
function depthOf(p: Vec3): number | null {
  const camera = frame.peek()?.header.camera;
  const depth = camera ? dot(sub(p, camera.eye_mm), camera.forward) : 0;
  return depth > 0 ? depth : null;
}

function focusOn(p: Vec3 | null | undefined): void {
  const depth = p && depthOf(p);
  if (depth) edit([["/camera/focus_mm", Number(depth.toPrecision(6))]]);
  else showToast({ text: "There is nothing to focus on" });
}

/** The eye. */
export function CameraPanel() {
  const of = scene.value;
  if (!of) return null;
  const { camera } = of;
  const target = camera.target_mm ?? [0, 0, 0];
  const orthographic = camera.projection === "orthographic";
  const targetDepth = depthOf(target);
  return (
    <>
      <Section title="Projection">
        <Segmented
          label="Kind"
          value={camera.projection}
          options={[
            { value: "perspective", label: "Perspective" },
            { value: "orthographic", label: "Parallel" },
          ]}
          onChange={(projection) => edit([["/camera/projection", projection]])}
        />
        <CameraNumber of={camera} name="vertical_fov_deg" disabled={orthographic} />
        <CameraNumber of={camera} name="zoom" />
      </Section>
      <Section title="View">
        {camera.eye_mm ? (
          <>
            <p class="note">The scene places the eye itself; angles do not count.</p>
            <div class="row-actions">
              <Button
                onClick={() =>
                  edit(
                    [
                      ["/camera/eye_mm", null],
                      ["/camera/up", null],
                    ],
                    newGesture("eye"),
                  )
                }
              >
                Use angles
              </Button>
            </div>
          </>
        ) : (
          <>
            <CameraNumber name="azimuth_deg" value={wrapDegrees(camera.azimuth_deg)} />
            <CameraNumber of={camera} name="elevation_deg" />
            <CameraNumber name="roll_deg" value={wrapDegrees(camera.roll_deg)} />
          </>
        )}
        <Field label="Target" hint="The point looked at, mm toward the patient's sides: R or L, A or P, I or S">
          {([0, 1, 2] as const).map((i) => (
            <NumberInput
              key={i}
              label={`Target ${"xyz"[i]}`}
              axis={i}
              value={target[i]!}
              onChange={(value, gesture) =>
                edit([["/camera/target_mm", target.map((x, k) => (k === i ? value : x))]], gesture)
              }
            />
          ))}
        </Field>
        <div class="row-actions">
          <Button icon="reset" disabled={camera.roll_deg === 0} onClick={() => edit([["/camera/roll_deg", 0]])}>
            Level
          </Button>
          <Button
            icon="fit"
            title="Turn about the point that the slices mark"
            onClick={() => crosshair.value && edit([["/camera/target_mm", crosshair.value]])}
          >
            Target the crosshair
          </Button>
        </div>
      </Section>
      <Section title="Depth of field">
        <CameraNumber of={camera} name="aperture_radius_mm" />
        <CameraNumber name="focus_mm" max={Math.max(1000, (2 * (targetDepth ?? 0)) / reachFactor.value)} value={camera.focus_mm ?? targetDepth ?? 0} disabled={camera.aperture_radius_mm === 0} />
        <div class="row-actions">
          <Button
            primary={picking.value}
            title="Click the point that is to be sharp"
            onClick={() => void pickPoint().then((answer) => answer && focusOn(answer.position_mm))}
          >
            {picking.value ? "Click into the picture" : "Focus on a point"}
          </Button>
          <Button disabled={camera.focus_mm === undefined} onClick={() => edit([["/camera/focus_mm", null]])}>
            Focus on the target
          </Button>
        </div>
      </Section>
    </>
  );
}
