/** The resolved scene as the server sends it (docs/scene-reference.md): every field with a default is there, fields
 * without one may be absent. Lengths in mm, LPS; angles in degrees. */

export type Vec3 = readonly [number, number, number];
export type Range = readonly [number, number];

/** "#rrggbb" (sRGB), [r, g, b] (sRGB, 0 to 1), or linear Rec. 709. */
export type Color = string | Vec3 | { linear: Vec3 };

export interface VolumeSource {
  path: string;
  raw?: string;
  spacing_mm?: Vec3;
  origin_mm?: Vec3;
  direction?: number[];
}

export interface Proxy {
  name: string;
  kind: "file" | "gradient" | "smoothed" | "distance";
  path: string;
  of: string;
  sigma_mm: number;
  labels: number[];
  lookup: "linear" | "nearest";
  outline: "voxels" | "smooth";
}

export interface TransferPoint {
  value: number;
  opacity?: number;
  mu_t_per_mm?: number;
  color?: Color;
  emission?: Color;
  roughness?: number;
  metallic?: number;
  specular?: number;
  anisotropy?: number;
  surface_share?: number;
  extinction_color?: Color;
  material?: string;
}

export interface RuleColumn {
  at: number;
  points: TransferPoint[];
}

export interface Rule {
  kind: "cctf" | "cpctf" | "cdptf" | "mpctf" | "mdptf";
  volume: string;
  points: TransferPoint[];
  along: string;
  column_form: "curve" | "steps" | "points";
  columns: RuleColumn[];
}

export interface Transfer {
  preset: string;
  reference_length_mm?: number;
  density_scale: number;
  points: TransferPoint[];
  rules: Rule[];
  merge: "product" | "priority" | "maximum";
  smooth_labels: boolean;
}

export interface Labels {
  path: string;
  names: string;
  strength: number;
}

export interface Material {
  shading: "coexistence" | "er" | "phase" | "brdf" | "blinn-phong";
  surface_share: "hybrid" | "exponential" | "modulation" | "threshold";
  gradient_factor: number;
  opacity_modulated: boolean;
  anisotropy: number;
  roughness: number;
  specular: number;
  highlight: number;
  shininess: number;
  lobes: "auto" | "reciprocal" | "particles";
  self_occlusion: number;
}

export interface NamedMaterial {
  name: string;
  like?: string;
  [coefficient: string]: unknown;
}

export interface Illustration {
  ramp: TransferPoint[];
  direction: Vec3;
  attached_to: Attachment;
  contour: number;
  contour_width: number;
  contour_color: Color;
}

export interface Importance {
  importance: number;
  volume: string;
  range?: Range;
  along: string;
  along_range?: Range;
  center_mm?: Vec3;
  radius_mm?: number;
  size_mm?: Vec3;
}

export interface Visibility {
  important: Importance[];
  p: number;
  q: number;
  r: number;
  lambda: number;
  lights: "off" | "first" | "all";
  light_samples: number;
  ray_samples: number;
  ray_passes: number;
  lookup: "interpolated" | "per-voxel" | "smoothed";
  sums: "integral" | "discrete";
}

/** World: LPS mm. Camera: (right, up, toward the eye) in mm from the camera's target. */
export type Attachment = "world" | "camera";

export interface Light {
  kind: "directional" | "point" | "rect";
  attached_to: Attachment;
  color: Color;
  intensity: number;
  /** Directional: from the scene to the light, of any length. */
  direction?: Vec3;
  position_mm?: Vec3;
  target_mm?: Vec3;
  up?: Vec3;
  size_mm: readonly [number, number];
  two_sided: boolean;
}

export interface Environment {
  image: string;
  color: Color;
  intensity: number;
  rotation_deg: number;
  attached_to: Attachment;
  ambient: boolean;
}

export interface Background {
  kind: "color" | "environment" | "transparent";
  color: Color;
}

export interface Camera {
  projection: "perspective" | "orthographic";
  azimuth_deg: number;
  elevation_deg: number;
  roll_deg: number;
  zoom: number;
  vertical_fov_deg: number;
  target_mm?: Vec3;
  eye_mm?: Vec3;
  up?: Vec3;
  height_mm?: number;
  aperture_radius_mm: number;
  focus_mm?: number;
  background_blur_deg: number;
  fit_radius_mm?: number;
}

/** Lower and upper face of a box; null where it is open. */
export type Faces = readonly [number | null, number | null];

export interface Clip {
  x_mm: Faces;
  y_mm: Faces;
  z_mm: Faces;
  blocks_light: boolean;
}

export interface Picture {
  width: number;
  height: number;
  spp?: number;
  seconds?: number;
  noise?: number;
  filter: "gaussian" | "box";
  filter_radius_px: number;
  exposure_ev: number;
  tone_curve: "filmic" | "srgb";
  aovs: string[];
}

export interface Render {
  integrator: string;
  seed: number;
  frame: number;
  max_scatter: number;
  light_samples: number;
  denoise: string;
  light_sampling: "mis" | "light" | "direction";
  [field: string]: unknown;
}

export type FieldValue = number | boolean | string | number[] | Color | TransferPoint[];

export interface Track {
  field: string;
  interpolation: "linear" | "smooth" | "step";
  keys: [number, FieldValue][];
}

export interface Turntable {
  seconds: number;
  turns: number;
}

export interface Animation {
  fps: number;
  frames?: number;
  turntable?: Turntable;
  tracks: Track[];
}

export interface Scene {
  version: number;
  volume: VolumeSource;
  proxies: Proxy[];
  transfer: Transfer;
  labels?: Labels;
  material: Material;
  materials: NamedMaterial[];
  illustration?: Illustration;
  visibility?: Visibility;
  lights?: Light[];
  environment?: Environment;
  background?: Background;
  camera: Camera;
  clip?: Clip;
  image: Picture;
  render: Render;
  animation?: Animation;
}
