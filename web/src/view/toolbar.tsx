import { scene, section, edit } from "../state/scene";
import { setSplit, split } from "../state/session";
import { clipHandles, lightHandles, pointerTool } from "../state/tools";
import { Button, IconButton } from "../ui/controls";
import { fitView, toggleProjection } from "./camera-control";
import { cancelMeasuring, measurements, measuring, removeAll } from "./distances";

/** The tools over the picture, at its left edge. */

const clip = section("clip");

export const toggleMeasuring = () => (pointerTool.value = measuring.peek() ? "navigate" : "measure");
export const toggleLights = () => (lightHandles.value = !lightHandles.peek());
export const toggleClip = () => (clipHandles.value = !clipHandles.peek());
export const toggleSplit = () => setSplit(split.peek() === null ? 0.5 : null);

export const toolInUse = () => measuring.peek() || lightHandles.peek() || clipHandles.peek() || split.peek() !== null;

/** Ends measuring, or first the distance that is begun; else hides all handles. */
export function endTool(): void {
  if (measuring.peek()) return cancelMeasuring();
  lightHandles.value = false;
  clipHandles.value = false;
  if (split.peek() !== null) setSplit(null);
}

export function Toolbar() {
  const orthographic = scene.value?.camera.projection === "orthographic";
  return (
    <div class="tools floating" role="toolbar" aria-label="View tools" aria-orientation="vertical">
      <IconButton
        icon="measure"
        label="Measure distances"
        keys="M"
        pressed={measuring.value}
        onClick={(event) => {
          toggleMeasuring();
          // The keys that move the cursor are the picture's.
          (event.currentTarget as Element).closest<HTMLElement>(".view")?.focus({ preventScroll: true });
        }}
      />
      <IconButton icon="light" label="Light handles" keys="L" pressed={lightHandles.value} onClick={toggleLights} />
      <IconButton icon="clip" label="Clip handles" keys="C" pressed={clipHandles.value} onClick={toggleClip} />
      <IconButton
        icon="split"
        label="Compare with the picture before the denoiser"
        keys="D"
        pressed={split.value !== null}
        onClick={toggleSplit}
      />
      <hr />
      <IconButton icon="fit" label="Fit the volume into the view" keys="F" onClick={fitView} />
      <IconButton
        icon={orthographic ? "parallel" : "perspective"}
        label={
          orthographic ? "Parallel projection; change to perspective" : "Perspective; change to parallel projection"
        }
        keys="O"
        onClick={toggleProjection}
      />
    </div>
  );
}

/** What the chosen tool wants, beside the tools. */
export function ToolHint() {
  if (measuring.value)
    return (
      <div class="hint floating">
        <span>Click two points, or arrow keys and Enter</span>
        {measurements.value.length > 0 && <Button onClick={removeAll}>Delete all</Button>}
        <Button onClick={toggleMeasuring}>Done</Button>
      </div>
    );
  if (clipHandles.value)
    return (
      <div class="hint floating">
        <span>Drag a face of the box</span>
        {clip.value && <Button onClick={() => edit([["/clip", null]])}>Remove clip</Button>}
        <Button onClick={toggleClip}>Done</Button>
      </div>
    );
  if (lightHandles.value)
    return (
      <div class="hint floating">
        <span>Drag a light; wheel or Shift moves it nearer or farther</span>
        <Button onClick={toggleLights}>Done</Button>
      </div>
    );
  return null;
}
