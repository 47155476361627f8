import { signal } from "@preact/signals";
import { useEffect, useState } from "preact/hooks";
import {
  byShortestWay,
  capture,
  captureValues,
  deleteKeyframe,
  emptyAnimation,
  frameCount,
  interpolateAll,
  keyframesOf,
  orStill,
  turnsTwice,
  valuesAt,
  withoutCamera,
  type CapturePart,
} from "../../model/keyframes";
import { send } from "../../state/connection";
import { edit, newGesture, scene } from "../../state/scene";
import { exporting, hello } from "../../state/session";
import type { Animation, Scene, Track } from "../../state/scene-types";
import { Button, IconButton, NumberInput } from "../../ui/controls";
import { Icon, type IconName } from "../../ui/icons";
import { duration, endPreview, pause, placePlayhead, play, playhead, playing, previewing } from "./playback";
import { KeyframeStrip } from "./strip";

const parts: readonly { part: CapturePart; title: string; icon: IconName }[] = [
  { part: "camera", title: "camera", icon: "camera" },
  { part: "light", title: "lights and environment", icon: "light" },
  { part: "transfer", title: "transfer function", icon: "curve" },
  { part: "clip", title: "clip box", icon: "clip" },
];
/** What the next keyframes hold. */
const chosenParts = signal<ReadonlySet<CapturePart>>(new Set(["camera"]));

const kDefaultStep_s = 2;
const kSameTime_s = 1e-3;

function set(animation: Animation | null): void {
  edit([["/animation", animation]], newGesture("animation"));
}

/** Keyframes of camera, lights and so on; playing and writing what they make. */
export function AnimationPanel() {
  const of = scene.value;
  const [selected, setSelected] = useState<number | null>(null);
  useEffect(() => endPreview, []);
  if (!of) return null;
  const { animation } = of;
  const keyframes = keyframesOf(animation);
  const key = selected === null ? undefined : keyframes.find((one) => Math.abs(one.time - selected) < 1e-4);
  const captureAt = (time: number) => {
    const values = byShortestWay(animation, time, captureValues(of, chosenParts.value));
    if (values.length === 0) return;
    set(capture(animation, time, values));
    setSelected(time);
  };
  const add = () => {
    // Where the playhead stands; where that has a keyframe and nothing is previewed, some time after the last.
    const taken = keyframes.some((one) => Math.abs(one.time - playhead.value) < kSameTime_s);
    const time = taken && !previewing.value ? keyframes.at(-1)!.time + kDefaultStep_s : playhead.value;
    captureAt(time);
    placePlayhead(time);
  };
  return (
    <div class="animation">
      <div class="animation-bar" role="toolbar" aria-label="Animation">
        <Transport />
        <span class="bar-divider" />
        <Button icon="key" primary onClick={add} title="Adds a keyframe: keeps how the chosen parts are now">
          Keyframe
        </Button>
        <IconButton
          icon="check"
          label="Replace what the chosen keyframe holds by how it is now"
          disabled={!key}
          onClick={() => key && captureAt(key.time)}
        />
        <IconButton
          icon="upload"
          label="Set the scene as the chosen keyframe holds it"
          disabled={!key || !animation}
          onClick={() => {
            endPreview();
            edit(valuesAt(animation!, key!.time), newGesture("keyframe-apply"));
          }}
        />
        <span class="part-choice" role="group" aria-label="What a keyframe holds">
          {parts.map((one) => (
            <Part key={one.part} {...one} disabled={one.part === "clip" && !of.clip} />
          ))}
        </span>
        <IconButton
          icon="delete"
          label="Delete the chosen keyframe"
          disabled={!key || !animation}
          onClick={() => {
            set(orStill(deleteKeyframe(animation!, key!.time)));
            setSelected(null);
          }}
        />
        <span class="spring" />
        <Turntable animation={animation} />
        <Timing of={of} />
        <span class="bar-divider" />
        <Export frames={frameCount(animation)} name={of.volume.path} />
      </div>
      {turnsTwice(animation) && <TurnsTwice animation={animation!} />}
      <KeyframeStrip of={of} selected={key?.time ?? null} onSelect={setSelected} />
    </div>
  );
}

function Transport() {
  return (
    <>
      <IconButton
        icon={playing.value ? "pause" : "play"}
        label={playing.value ? "Pause" : "Play"}
        disabled={duration.value === 0}
        onClick={() => (playing.value ? pause() : void play())}
      />
      <span class="time">
        {playhead.value.toFixed(2)} <small>/ {duration.value.toFixed(2)} s</small>
      </span>
      <IconButton
        icon="eye"
        label={previewing.value ? "Show the scene as it is" : "The picture shows the scene as it is"}
        pressed={previewing.value}
        disabled={!previewing.value}
        onClick={endPreview}
      />
    </>
  );
}

function Part(props: { part: CapturePart; title: string; icon: IconName; disabled: boolean }) {
  const { part, title } = props;
  const on = chosenParts.value.has(part) && !props.disabled;
  const toggle = () => {
    const next = new Set(chosenParts.peek());
    if (on) next.delete(part);
    else next.add(part);
    chosenParts.value = next;
  };
  return (
    <IconButton
      icon={props.icon}
      label={`Keyframes hold: ${title}`}
      pressed={on}
      disabled={props.disabled}
      onClick={toggle}
    />
  );
}

function Turntable({ animation }: { animation: Animation | undefined }) {
  const turntable = animation?.turntable;
  if (!turntable)
    return (
      <IconButton
        icon="turntable"
        label="Turntable: once around in 6 s"
        onClick={() => set({ ...(animation ?? emptyAnimation), turntable: { seconds: 6, turns: 1 } })}
      />
    );
  return (
    <span class="bar-group">
      <Icon name="turntable" />
      <NumberInput
        label="Turns"
        digits={2}
        min={-50}
        max={50}
        value={turntable.turns}
        unit="×"
        onChange={(turns, gesture) => edit([["/animation/turntable/turns", turns]], gesture)}
      />
      <NumberInput
        label="Seconds of all turns"
        digits={2}
        min={0.05}
        unit="s"
        value={turntable.seconds}
        onChange={(seconds, gesture) => edit([["/animation/turntable/seconds", seconds]], gesture)}
      />
      <IconButton
        icon="close"
        label="Remove the turntable"
        onClick={() => {
          const { turntable: _, ...rest } = animation;
          set(orStill(rest));
        }}
      />
    </span>
  );
}

/** A turntable beside keyframes of the camera: what comes of it, and a way out. */
function TurnsTwice({ animation }: { animation: Animation }) {
  const { turntable, ...alone } = animation;
  return (
    <p class="strip-note" role="status">
      <Icon name="warning" />
      <span>
        The turntable turns the camera in addition to its keyframes, and the film ends with it after{" "}
        {turntable!.seconds} s.
      </span>
      <Button onClick={() => set(withoutCamera(animation))}>Replace the keyframes</Button>
      <Button onClick={() => set(alone)}>Remove the turntable</Button>
    </p>
  );
}

function Timing({ of }: { of: Scene }) {
  const { animation } = of;
  if (!animation) return null;
  const interpolation: Track["interpolation"] = animation.tracks[0]?.interpolation ?? "smooth";
  return (
    <span class="bar-group">
      {animation.tracks.length > 0 && (
        <select
          class="bar-select"
          aria-label="Between keyframes"
          value={interpolation}
          onChange={(event) => set(interpolateAll(animation, event.currentTarget.value as Track["interpolation"]))}
        >
          <option value="smooth">Smooth</option>
          <option value="linear">Linear</option>
          <option value="step">Steps</option>
        </select>
      )}
      <NumberInput
        label="Frames a second"
        unit="fps"
        digits={2}
        min={1}
        max={1000}
        value={animation.fps}
        onChange={(fps, gesture) => edit([["/animation/fps", fps]], gesture)}
      />
    </span>
  );
}

const formats = ["mp4", "webm", "zip"] as const;
/** Null: not chosen yet. */
const chosenFormat = signal<(typeof formats)[number] | null>(null);

function Export({ frames, name }: { frames: number; name: string }) {
  const state = exporting.value;
  const movies = hello.value?.movies ?? true;
  const format = movies ? (chosenFormat.value ?? "mp4") : "zip";
  const stem =
    name
      .split("/")
      .at(-1)!
      .replace(/(\.nii)?\.[^.]*$/, "")
      .replace(/[^\w-]+/g, "-") || "animation";
  if (state?.state === "running") {
    const share = state.frames ? state.frames_done / state.frames : 0;
    return (
      <span class="bar-group" role="status">
        <progress value={share} aria-label="Writing the animation" />
        <span class="time">
          {state.frames_done < state.frames ? state.frames_done : "Writing the file,"}{" "}
          <small>{state.frames_done < state.frames ? `/ ${state.frames}` : `${state.frames} frames`}</small>
        </span>
        <Button onClick={() => send({ type: "cancel_export" })}>Cancel</Button>
      </span>
    );
  }
  return (
    <span class="bar-group">
      {state?.state === "done" && (
        <a
          class="icon-button"
          href={`api/export/${encodeURIComponent(state.file)}`}
          download={state.file}
          aria-label={`Save ${state.file}`}
          title={`Save ${state.file}`}
        >
          <Icon name="download" />
        </a>
      )}
      {state?.state === "failed" && (
        <span class="note warning" title={state.message}>
          {state.message ?? "Failed"}
        </span>
      )}
      <select
        class="bar-select"
        aria-label="Format"
        title={movies ? undefined : "Movies need ffmpeg where the viewer runs: install ffmpeg, then reload this page"}
        value={format}
        onChange={(event) => (chosenFormat.value = event.currentTarget.value as (typeof formats)[number])}
      >
        {formats.map((one) => (
          <option key={one} value={one} disabled={one !== "zip" && !movies}>
            {one === "zip" ? "PNG (zip)" : movies ? one : `${one}: install ffmpeg`}
          </option>
        ))}
      </select>
      <Button
        icon="film"
        disabled={frames === 0}
        title={`${frames} frames`}
        onClick={() => (endPreview(), send({ type: "export", file: `${stem}.${format}` }))}
      >
        Export
      </Button>
    </span>
  );
}
