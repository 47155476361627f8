import type { Scene, Vec3 } from "./scene-types";

/** The messages of docs/viewer-protocol.md. */

/** A JSON pointer into the scene and its new value; null removes. */
export type Assignment = readonly [pointer: string, value: unknown];

export type PageMessage =
  | { type: "edit"; seq: number; set: readonly Assignment[]; gesture?: string }
  | { type: "passing"; seq: number; set: readonly Assignment[] }
  | { type: "undo" }
  | { type: "redo" }
  | { type: "load"; scene: unknown }
  | { type: "open"; path: string }
  | { type: "cancel_open" }
  | { type: "split"; at: number | null }
  | { type: "seek"; time_s: number | null }
  | ({ type: "probe"; id: number } & ProbedPlace)
  | { type: "export"; file: string }
  | { type: "cancel_export" }
  | { type: "draw_presets" }
  | { type: "shown"; frame: number };

/** A place of the picture, 0 to 1 from the top left, or of the volume. */
export type ProbedPlace = { x: number; y: number } | { position_mm: Vec3 };

export interface Named {
  name: string;
  summary: string;
}

export interface Hello {
  type: "hello";
  version: string;
  presets: Named[];
  materials: (Named & { color: string })[];
  denoisers: Named[];
  environments: { name: string; path: string }[];
  samples: (Named & { path: string })[];
  folder: string;
  /** Whether there is an ffmpeg to write movies with. */
  movies: boolean;
}

export interface SceneMessage {
  type: "scene";
  revision: number;
  scene: Scene;
  can_undo: boolean;
  can_redo: boolean;
}

export interface Edited {
  type: "edited";
  revision: number;
  seq?: number;
  sections: Record<string, unknown>;
  can_undo: boolean;
  can_redo: boolean;
}

export interface Refused {
  type: "refused";
  seq: number;
  where: string;
  message: string;
}

export interface Status {
  type: "status";
  stage: "empty" | "reading" | "preparing" | "ready" | "failed";
  what?: string;
  message?: string;
  /** 0 to 1, where known. */
  share?: number;
  /** What was being opened is not any more; what was open before still is. */
  given_up?: boolean;
}

export interface Trouble {
  type: "trouble";
  message: string;
}

/** What of the scene may not be as its user expects. */
export interface Warnings {
  type: "warnings";
  lines: string[];
}

export interface Progress {
  type: "progress";
  spp: number;
  noise: number | null;
  remaining_s: number | null;
  samples_per_s: number;
}

/** What the next picture needs before its samples, where that takes more than a second. */
export interface Compiling {
  type: "compiling";
  /** 0 to 1; 1 at its end. */
  share: number;
}

export interface Probe {
  type: "probe";
  id: number;
  hit: boolean;
  position_mm?: Vec3;
  voxel?: Vec3;
  /** Null where the data is not finite. */
  value?: number | null;
  labels?: { of: string; value: number; name: string }[];
}

export interface ExportState {
  type: "export";
  state: "running" | "done" | "failed" | "cancelled";
  frames_done: number;
  frames: number;
  file: string;
  message?: string;
}

export interface Split {
  type: "split";
  at: number | null;
}

/** /api/preset/NAME.png is there. */
export interface PresetDrawn {
  type: "preset_drawn";
  name: string;
}

export interface Viewers {
  type: "viewers";
  count: number;
}

export type ServerMessage =
  | Hello
  | SceneMessage
  | Edited
  | Refused
  | Status
  | Trouble
  | Warnings
  | Progress
  | Compiling
  | Probe
  | ExportState
  | Split
  | PresetDrawn
  | Viewers;

/** The camera of a picture. half_width and half_height are tangents (perspective) or mm (orthographic). */
export interface FrameCamera {
  eye_mm: Vec3;
  right: Vec3;
  up: Vec3;
  forward: Vec3;
  half_width: number;
  half_height: number;
  orthographic: boolean;
}

export type Limit = "tracing" | "denoising" | "compiling" | "developing" | "nothing";

/** What precedes a picture in a binary frame. */
export interface FrameHeader {
  frame: number;
  revision: number;
  moving: boolean;
  format: "jpeg" | "png";
  width: number;
  height: number;
  full: readonly [number, number];
  spp: number;
  noise: number | null;
  done: boolean;
  frame_s: number;
  compile_s: number;
  trace_s: number;
  denoise_s: number;
  develop_s: number;
  fps: number;
  limit: Limit;
  camera: FrameCamera;
}
