import type { Animation, FieldValue, Scene, Track } from "../state/scene-types";

/** Keys whose times differ by less belong to one keyframe [s]. */
const together = 1e-4;

/** All that has a key at a time. */
export interface Keyframe {
  time: number;
  fields: string[];
}

/** The times at which anything has a key, in order. */
export function keyframesOf(animation: Animation | undefined): Keyframe[] {
  const out: Keyframe[] = [];
  for (const track of animation?.tracks ?? [])
    for (const [time] of track.keys) {
      const there = out.find((k) => Math.abs(k.time - time) < together);
      if (!there) out.push({ time, fields: [track.field] });
      else if (!there.fields.includes(track.field)) there.fields.push(track.field);
    }
  return out.sort((a, b) => a.time - b.time);
}

/** As the renderer counts: those given, else the turntable's, else up to and with the last key. */
export function frameCount(animation: Animation | undefined): number {
  if (!animation) return 0;
  const { fps, frames, turntable } = animation;
  if (frames !== undefined) return frames;
  if (turntable) return Math.max(1, Math.round(turntable.seconds * fps));
  const last = keyframesOf(animation).at(-1);
  return last ? Math.max(1, Math.round(last.time * fps) + 1) : 0;
}

export function durationOf(animation: Animation | undefined): number {
  return animation ? frameCount(animation) / animation.fps : 0;
}

/** A still picture with nothing that moves yet. */
export const emptyAnimation: Animation = { fps: 30, tracks: [] };

function withTracks(animation: Animation | undefined, tracks: Track[]): Animation {
  return { ...(animation ?? emptyAnimation), tracks: tracks.filter((track) => track.keys.length > 0) };
}

function sorted(keys: [number, FieldValue][]): [number, FieldValue][] {
  return keys
    .map((key, i) => ({ key, i }))
    .sort((a, b) => a.key[0] - b.key[0] || a.i - b.i)
    .map(({ key }) => key);
}

/** Sets the values of fields at a time; keys of theirs that are there already are replaced. New tracks are smooth. */
export function capture(
  animation: Animation | undefined,
  time: number,
  values: readonly [string, FieldValue][],
): Animation {
  const tracks = (animation?.tracks ?? []).map((track) => ({ ...track }));
  for (const [field, value] of values) {
    let track = tracks.find((one) => one.field === field);
    if (!track) tracks.push((track = { field, interpolation: "smooth", keys: [] }));
    track.keys = sorted([...track.keys.filter(([t]) => Math.abs(t - time) >= together), [time, value]]);
  }
  return withTracks(animation, tracks);
}

/** Moves all keys at `from` to `to`. Keys that were there give way. */
export function moveKeyframe(animation: Animation, from: number, to: number): Animation {
  if (Math.abs(from - to) < together) return animation;
  return withTracks(
    animation,
    animation.tracks.map((track) => {
      const moved = track.keys.filter(([t]) => Math.abs(t - from) < together);
      if (!moved.length) return track;
      const others = track.keys.filter(([t]) => Math.abs(t - from) >= together && Math.abs(t - to) >= together);
      return { ...track, keys: sorted([...others, ...moved.map(([, value]): [number, FieldValue] => [to, value])]) };
    }),
  );
}

/** What a keyframe holds; of two keys of a field at its time the later one. */
export function valuesAt(animation: Animation, time: number): [string, FieldValue][] {
  return animation.tracks.flatMap((track) => {
    const key = track.keys.filter(([t]) => Math.abs(t - time) < together).at(-1);
    return key ? [[track.field, key[1]] as [string, FieldValue]] : [];
  });
}

export function deleteKeyframe(animation: Animation, time: number): Animation {
  return withTracks(
    animation,
    animation.tracks.map((track) => ({
      ...track,
      keys: track.keys.filter(([t]) => Math.abs(t - time) >= together),
    })),
  );
}

/** Sets the interpolation of all tracks. */
export function interpolateAll(animation: Animation, interpolation: Track["interpolation"]): Animation {
  return withTracks(
    animation,
    animation.tracks.map((track) => ({ ...track, interpolation })),
  );
}

/** Replaces the tracks of the fields that `tracks` move. */
export function withTracksOf(animation: Animation | undefined, tracks: readonly Track[]): Animation {
  const kept = (animation?.tracks ?? []).filter((track) => !tracks.some((one) => one.field === track.field));
  return withTracks(animation, [...kept, ...tracks]);
}

/** Null where nothing is left that moves, so that the scene is a still again. */
export function orStill(animation: Animation): Animation | null {
  return animation.turntable || animation.tracks.length > 0 || animation.frames !== undefined ? animation : null;
}

const isOfCamera = ({ field }: Track) => field.startsWith("/camera/");

/** What a turntable moves. */
const turnedFields = ["/camera/azimuth_deg", "/camera/eye_mm", "/camera/up"];

/** Whether a turntable turns a camera that its keyframes turn as well, or ends before they do. */
export function turnsTwice(animation: Animation | undefined): boolean {
  const { turntable, tracks, fps } = animation ?? emptyAnimation;
  if (!turntable) return false;
  const turns = ({ field, keys }: Track) =>
    turnedFields.includes(field) && new Set(keys.map(([, value]) => JSON.stringify(value))).size > 1;
  const goesOn = ({ keys }: Track) => keys.some(([time]) => time > turntable.seconds + 1 / fps);
  return tracks.filter(isOfCamera).some((track) => turns(track) || goesOn(track));
}

/** Without the keyframes of the camera. */
export function withoutCamera(animation: Animation): Animation {
  return withTracks(
    animation,
    animation.tracks.filter((track) => !isOfCamera(track)),
  );
}

/** What may be captured, in the words of the page. */
export type CapturePart = "camera" | "light" | "transfer" | "clip";

const cameraFields = [
  "azimuth_deg",
  "elevation_deg",
  "roll_deg",
  "zoom",
  "vertical_fov_deg",
  "target_mm",
  "eye_mm",
  "up",
  "height_mm",
  "focus_mm",
  "aperture_radius_mm",
];
const lightFields = ["intensity", "color", "direction", "position_mm"];
/** Written as they are; a way from 170 to -170 would go almost once around. */
const angleFields = ["/camera/azimuth_deg", "/camera/roll_deg", "/environment/rotation_deg"];

/** The fields of the parts as they are in the scene, with their values. What is absent is not captured. */
export function captureValues(scene: Scene, parts: ReadonlySet<CapturePart>): [string, FieldValue][] {
  const out: [string, FieldValue][] = [];
  const take = (where: string, from: object | undefined, names: readonly string[]) => {
    for (const name of names) {
      const value = (from as Record<string, FieldValue | undefined> | undefined)?.[name];
      if (value !== undefined) out.push([`${where}/${name}`, value]);
    }
  };
  if (parts.has("camera")) take("/camera", scene.camera, cameraFields);
  if (parts.has("light")) {
    (scene.lights ?? []).forEach((light, i) => take(`/lights/${i}`, light, lightFields));
    take("/environment", scene.environment, ["intensity", "rotation_deg", "color"]);
  }
  if (parts.has("transfer"))
    take("/transfer", scene.transfer, scene.transfer.points.length ? ["points", "density_scale"] : ["density_scale"]);
  if (parts.has("clip")) take("/clip", scene.clip, ["x_mm", "y_mm", "z_mm"]);
  return out;
}

/** `angle` plus the whole turns that bring it nearest to `to`. */
export function nearestTurn(angle: number, to: number): number {
  return angle + 360 * Math.round((to - angle) / 360);
}

/** `values` with angles turned to where the keys before `time` lead to by the shortest way. */
export function byShortestWay(
  animation: Animation | undefined,
  time: number,
  values: readonly [string, FieldValue][],
): [string, FieldValue][] {
  return values.map(([field, value]) => {
    const keys = angleFields.includes(field)
      ? animation?.tracks.find((track) => track.field === field)?.keys
      : undefined;
    const before = keys?.filter(([t]) => t < time - together).at(-1)?.[1];
    return [field, typeof before === "number" && typeof value === "number" ? nearestTurn(value, before) : value];
  });
}
