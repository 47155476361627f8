#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace voxlume {

// The scene as a user describes it: plain data, mutable, with the defaults of the scene file. Empty optionals
// are chosen from the volume by resolve() (the default picture). Positions are LPS mm, directions LPS,
// lengths mm, extinction 1/mm, angles degrees, radiance linear Rec. 709.

using Double3 = std::array<double, 3>;

/// Linear Rec. 709. In files "#rrggbb" or [r,g,b] are sRGB-encoded; {"linear":[r,g,b]} is taken as it is.
struct Color {
  std::array<float, 3> linear{1, 1, 1};
  friend bool operator==(const Color&, const Color&) = default;
};

/// Where the voxels come from.
struct VolumeDescription {
  std::string path;  ///< file or folder; relative to the scene file's folder. "phantom" is built in
  std::string raw;   ///< RawSpec text when `path` is headerless, else empty
  std::optional<Double3> spacing_mm;  ///< overrides the file's
  std::optional<Double3> origin_mm;   ///< overrides the file's: LPS position of the first voxel's centre
  /// Overrides the file's: row-major 3x3, column a is the LPS direction of index axis a; orthonormal.
  std::optional<std::array<double, 9>> direction;
  friend bool operator==(const VolumeDescription&, const VolumeDescription&) = default;
};

/// One control point. Every coefficient has its own piecewise-linear curve through the points that give it.
struct TransferPoint {
  double value = 0;                          ///< data units; points are sorted; two at one value are a step
  std::optional<double> opacity;             ///< [0,1] per reference length
  std::optional<double> mu_t_per_mm;         ///< >= 0; a function uses either opacity or this, not both
  std::optional<Color> color;                ///< scattering albedo, each channel in [0,1]
  std::optional<Color> emission;             ///< emitted radiance of an opaque region, >= 0
  std::optional<double> roughness = {};      ///< [0,1]
  std::optional<double> metallic = {};       ///< [0,1]
  std::optional<double> specular = {};       ///< [0,1]
  std::optional<double> anisotropy = {};     ///< (-1,1)
  std::optional<double> surface_share = {};  ///< [0,1]: multiplies the share that follows from the gradient
  /// [0,1]: multiplies the extinction of each channel, with Extinction::kRgb; absent everywhere: white
  std::optional<Color> extinction_color = {};
  std::string material = {};  ///< of material rules: a name of `materials` or of the library
  friend bool operator==(const TransferPoint&, const TransferPoint&) = default;
};

/// A volume beside the main one that rules read: a file, or derived from another.
enum class ProxyKind { kFile, kGradient, kSmoothed, kDistance };
enum class Lookup { kLinear, kNearest };
/// Where labels end: at the faces of voxels, or where a smooth field has it (grid/label_outline.h).
enum class Outline { kVoxels, kSmooth };
struct ProxyDescription {
  std::string name;  ///< what rules call it; neither "data" nor "opacity"
  ProxyKind kind = ProxyKind::kFile;
  std::string path;                    ///< kFile: any volume file, on any grid
  std::string of = "data";             ///< derived: the volume it is derived from
  double sigma_mm = 1;                 ///< kSmoothed: of the Gaussian; > 0
  std::vector<std::int64_t> labels;    ///< kDistance: the labels that are inside
  Lookup lookup = Lookup::kLinear;     ///< nearest: labels, whole numbers that are never interpolated
  Outline outline = Outline::kSmooth;  ///< nearest: where labels end
  friend bool operator==(const ProxyDescription&, const ProxyDescription&) = default;
};

/// The five kinds of transfer function of xu2025 section 5: CCTF, CPCTF, CDPTF, MPCTF, MDPTF.
enum class RuleKind {
  kCoefficientCurve,   ///< linear between points
  kCoefficientSteps,   ///< a point holds up to the next one; nothing below the first
  kCoefficientPoints,  ///< a point holds at its value alone
  kMaterialSteps,      ///< steps that name materials
  kMaterialPoints      ///< points that name materials
};
/// How a 2-D rule goes from one column to the next.
enum class ColumnForm { kCurve, kSteps, kPoints };

/// The function of a 2-D rule at one value of its second volume.
struct RuleColumn {
  double at = 0;  ///< value of the second volume; columns are sorted, no two alike
  std::vector<TransferPoint> points;
  friend bool operator==(const RuleColumn&, const RuleColumn&) = default;
};

/// A transfer function of a volume other than by `points`: 1-D with points, or 2-D with columns.
struct RuleDescription {
  RuleKind kind = RuleKind::kCoefficientCurve;
  std::string volume = "data";  ///< "data", "opacity" (of the transfer function's own points) or a proxy
  std::vector<TransferPoint> points;
  std::string along;  ///< 2-D: the second volume
  ColumnForm column_form = ColumnForm::kCurve;
  std::vector<RuleColumn> columns;
  friend bool operator==(const RuleDescription&, const RuleDescription&) = default;
};

/// How rules and the transfer function's own points, which count as the last rule, become one.
enum class Merge {
  kProduct,   ///< every coefficient is the product of the rules that give it
  kPriority,  ///< every coefficient is the first rule's that applies and gives it
  kMaximum    ///< the rule of the greatest extinction comes first, the others in order
};

/// Data value to optical coefficients: interpolate the data, then classify.
struct TransferDescription {
  std::string preset;                         ///< a preset name; its points are used when `points` is empty
  std::optional<double> reference_length_mm;  ///< mu_t = -ln(1 - min(o, 0.9999)) / reference_length_mm; > 0
  double density_scale = 1;                   ///< multiplies mu_t; >= 0
  std::vector<TransferPoint> points;
  std::vector<RuleDescription> rules;
  Merge merge = Merge::kPriority;
  bool smooth_labels = true;  ///< normals at borders of labels come from a smoothed field
  friend bool operator==(const TransferDescription&, const TransferDescription&) = default;
};

/// A material by name. What is absent is that of `like`, else the scene's `material`.
struct NamedMaterialDescription {
  std::string name;
  std::string like;                            ///< a material of the library (docs/materials.md), or none
  std::optional<double> opacity;               ///< [0,1] per reference length; absent: the rules' own
  std::optional<double> mu_t_per_mm;           ///< instead of an opacity
  std::optional<Color> color;                  ///< [0,1]
  std::optional<Color> emission;               ///< >= 0
  std::optional<double> roughness;             ///< [0,1]
  std::optional<double> metallic;              ///< [0,1]: share of metal among surface particles
  std::optional<double> specular;              ///< [0,1]
  std::optional<double> anisotropy;            ///< (-1,1)
  std::optional<double> surface_share;         ///< [0,1]: multiplies the share that follows from the gradient
  std::optional<double> transmission;          ///< [0,1]: share of rough glass among the rest of the surface
  std::optional<double> ior;                   ///< [1,4]: of the glass
  std::optional<double> diffuse_roughness;     ///< [0,1]: 0 is Lambert
  std::optional<double> back_anisotropy;       ///< (-1,1): of a second lobe of the phase function
  std::optional<double> back_share;            ///< [0,1]: of that lobe
  std::optional<Color> extinction_color = {};  ///< [0,1]: as a transfer point's
  friend bool operator==(const NamedMaterialDescription&, const NamedMaterialDescription&) = default;
};

/// Colours of a label volume over the transfer function's colour (nearest lookup; opacity is not changed).
struct LabelsDescription {
  std::string path;     ///< label volume, any integer type, any grid
  std::string names;    ///< .txt/.lut of names and colours; empty looks beside `path`
  double strength = 1;  ///< [0,1]: how much of the label's colour replaces the function's
  friend bool operator==(const LabelsDescription&, const LabelsDescription&) = default;
};

enum class Shading { kCoexistence, kExposureRender, kPhase, kBrdf, kBlinnPhong };
/// Reciprocal: one BRDF that absorbs what its parts do not reflect. Particles: normalised lobes, all
/// absorption in the colours (xu2025 section 3.2). Auto: particles where materials or rules ask for more than
/// colours.
enum class LobeModel { kAuto, kReciprocal, kParticles };
enum class SurfaceShareForm { kHybrid, kExponential, kModulation, kThreshold };

/// How matter scatters, beyond its albedo.
struct MaterialDescription {
  Shading shading = Shading::kCoexistence;
  SurfaceShareForm surface_share = SurfaceShareForm::kHybrid;
  double gradient_factor = 0.5;   ///< hybrid: exponent 25 f^3; exponential: f itself; >= 0
  bool opacity_modulated = true;  ///< hybrid: multiply the share by the opacity
  double anisotropy = 0;          ///< Henyey-Greenstein g in (-1, 1)
  double roughness = 0.4;         ///< GGX alpha = roughness^2; [0,1]
  double specular = 0.5;          ///< Fresnel F0 = 0.08 * specular; [0,1]; 0 leaves Lambert alone
  double highlight = 1;           ///< blinn-phong: times the gradient of the extinction; >= 0
  double shininess = 40;          ///< blinn-phong: exponent of the highlight; >= 0
  LobeModel lobes = LobeModel::kAuto;
  /// Multiplies the extinction that shadow rays meet, in (0, 1]; 1 is physical (xu2025 section 3.4).
  double self_occlusion = 1;
  friend bool operator==(const MaterialDescription&, const MaterialDescription&) = default;
};

enum class LightKind { kDirectional, kPoint, kRect };
/// What a position or direction is relative to. World: LPS mm. Camera: (right, up, toward the eye) in mm from
/// the camera's target, so that orbiting carries the light along and zooming does not change it.
enum class Attachment { kWorld, kCamera };

/// A light other than the environment.
struct LightDescription {
  LightKind kind = LightKind::kDirectional;
  Attachment attached_to = Attachment::kWorld;
  Color color;
  /// Directional: irradiance on a plane facing it. Point: radiant intensity (irradiance at d mm is
  /// intensity/d^2). Rect: radiance. >= 0
  double intensity = 1;
  std::optional<Double3> direction;    ///< directional: from the scene TO the light; need not be unit
  std::optional<Double3> position_mm;  ///< point, rect (its centre)
  std::optional<Double3> target_mm;    ///< rect: the point its front faces; default the camera's target
  std::optional<Double3> up;  ///< rect: direction of its height axis; default the camera's or world up
  std::array<double, 2> size_mm{100, 100};  ///< rect: width, height; > 0
  bool two_sided = false;                   ///< rect: emits from its back as well
  friend bool operator==(const LightDescription&, const LightDescription&) = default;
};

/// Light from everywhere: a colour, or an equirectangular picture times that colour.
struct EnvironmentDescription {
  std::string image;  ///< EXR or HDR, width = 2 height; empty is constant. +z (head) is its top
  Color color;
  double intensity = 1;     ///< radiance scale, >= 0
  double rotation_deg = 0;  ///< about +z, toward the patient's left
  Attachment attached_to = Attachment::kWorld;
  /// Adds albedo times the mean radiance to every scattering, unshadowed (xu2024 6.1). Not physical.
  bool ambient = false;
  friend bool operator==(const EnvironmentDescription&, const EnvironmentDescription&) = default;
};

enum class BackgroundKind { kColor, kEnvironment, kTransparent };
struct BackgroundDescription {
  BackgroundKind kind = BackgroundKind::kColor;
  Color color{{0, 0, 0}};
  friend bool operator==(const BackgroundDescription&, const BackgroundDescription&) = default;
};

enum class Projection { kPerspective, kOrthographic };
/// The eye. Either by angles around the target (0,0 looks at the patient's face, head up), or by eye_mm.
struct CameraDescription {
  Projection projection = Projection::kPerspective;
  double azimuth_deg = 0;    ///< grows toward the patient's left
  double elevation_deg = 0;  ///< toward the head; [-90, 90]
  double roll_deg = 0;       ///< clockwise turn of the camera about its axis
  double zoom = 1;           ///< > 0; 1 fits the bounding sphere of the volume or of what the clip box keeps
  double vertical_fov_deg = 30;      ///< perspective; (0, 170]
  std::optional<Double3> target_mm;  ///< default: centre of what is visible
  std::optional<Double3> eye_mm;     ///< overrides angles and zoom
  std::optional<Double3> up;         ///< with eye_mm; default +z
  std::optional<double> height_mm;   ///< orthographic: height of the view; default fits, divided by zoom
  double aperture_radius_mm = 0;     ///< thin lens for the volume; 0 is a pinhole
  std::optional<double> focus_mm;    ///< distance of the sharp plane from the eye; default the target's
  /// Blur of the environment behind the volume, as the half angle of its own large lens (xu2024 6.1); [0, 45]
  double background_blur_deg = 0;
  /// Radius of the sphere that zoom 1 fits, > 0; default that of what is visible
  std::optional<double> fit_radius_mm;
  friend bool operator==(const CameraDescription&, const CameraDescription&) = default;
};

/// Keeps what is inside an axis-aligned box of LPS space.
struct ClipDescription {
  std::array<double, 2> x_mm{-1e30, 1e30}, y_mm{-1e30, 1e30}, z_mm{-1e30, 1e30};
  bool blocks_light = false;  ///< true: what is cut away still casts its shadow
  friend bool operator==(const ClipDescription&, const ClipDescription&) = default;
};

/// What the user marks as important (lerzer2025 section 4.2): where all that is given holds.
struct ImportanceDescription {
  double importance = 1;                             ///< [0,1]; where several hold, the greatest counts
  std::string volume = "data";                       ///< "data" or a proxy
  std::optional<std::array<double, 2>> range;        ///< of the volume's values
  std::string along;                                 ///< 2-D: a second volume
  std::optional<std::array<double, 2>> along_range;  ///< of its values
  std::optional<Double3> center_mm;                  ///< of a region, which is a sphere or a box
  std::optional<double> radius_mm;                   ///< > 0
  std::optional<Double3> size_mm;                    ///< edges, > 0
  friend bool operator==(const ImportanceDescription&, const ImportanceDescription&) = default;
};

/// At which scatterings light rays are freed of what hides the important, too.
enum class VisibilityLights { kOff, kFirst, kAll };

/// Whether importance is looked up in interpolated values, or is interpolated between the voxels': as it is,
/// or after a mean of 3 x 3 x 3 voxels (lerzer2025 Fig. 11).
enum class ImportanceLookup { kInterpolated, kPerVoxel, kSmoothed };
/// Ray-march: the integrals of h, or sums over the steps, whose result depends on their length (lerzer2025
/// eqs. 3 and 7).
enum class ImportanceSums { kIntegral, kDiscrete };

/// What hides or clutters the important becomes transparent just enough (docs/visibility.md): mu_t is
/// multiplied by p / (p + (1 - importance)^(2 lambda) h). Lengths in h are in halves of the volume's longest
/// side.
struct VisibilityDescription {
  std::vector<ImportanceDescription> important;
  double p = 1;       ///< weight of what matter is; > 0
  double q = 70;      ///< of what is before the important; >= 0
  double r = 30;      ///< of what is behind it; >= 0
  double lambda = 1;  ///< >= 0
  VisibilityLights lights = VisibilityLights::kOff;
  int light_samples = 200;  ///< looks along a light ray
  int ray_samples = 48;     ///< looks of a pass along a pixel's ray
  int ray_passes = 16;
  ImportanceLookup lookup = ImportanceLookup::kInterpolated;
  ImportanceSums sums = ImportanceSums::kIntegral;
  friend bool operator==(const VisibilityDescription&, const VisibilityDescription&) = default;
};

enum class PixelFilter { kGaussian, kBox };
/// How the first random numbers of a pixel's samples are chosen.
enum class Sampler { kSobol, kRandom };
enum class TransmittanceEstimator { kRatio, kResidual, kMarching };
enum class FreeFlightSampling { kDelta, kDecomposition };
/// Single: one mu_t for all channels. Rgb: mu_t times the extinction colour (docs/rgb-extinction.md).
enum class Extinction { kSingle, kRgb };
/// How a picture is computed: by path tracing, or as other renderers do (docs/peers.md). Ar2t is path tracing
/// with materials by opacity; resolve() writes those out.
enum class Integrator { kPath, kExposureRender, kRmss, kVplDvr, kAr2t, kRayMarch };
enum class ToneCurve { kFilmic, kSrgb };

/// The picture: its size, how long to work on it and how it is developed.
struct ImageDescription {
  int width = 1024, height = 1024;  ///< 1..65536
  std::optional<int> spp;           ///< stop after this many samples per pixel
  std::optional<double> seconds;    ///< stop after this time
  std::optional<double> noise;      ///< stop when mean(standard error / (luminance + 0.01)) <= this
  PixelFilter filter = PixelFilter::kGaussian;
  double filter_radius_px =
      1.5;                 ///< box: half width (0.5 is one pixel); gaussian: cut at this, sigma a third
  double exposure_ev = 0;  ///< PNG: radiance times 2^EV
  ToneCurve tone_curve = ToneCurve::kFilmic;
  std::vector<std::string> aovs;  ///< alpha depth normal albedo samples variance
  friend bool operator==(const ImageDescription&, const ImageDescription&) = default;
};

/// A drawing in place of light transport (xu2025 Fig. 8): what a camera ray meets first has its albedo times
/// a ramp, by how much it faces a light, and dark contours.
struct IllustrationDescription {
  /// By the cosine between the normal and the light, -1 to 1; only `color` is used. Empty: cool to warm.
  std::vector<TransferPoint> ramp;
  Double3 direction{-1, 1.2, 1.5};  ///< from the scene TO the light; need not be unit
  Attachment attached_to = Attachment::kCamera;
  double contour = 0.8;        ///< [0,1]: how much contours replace the colour
  double contour_width = 0.3;  ///< [0,1]: cosine between the normal and the view below which they begin
  Color contour_color{{0, 0, 0}};
  friend bool operator==(const IllustrationDescription&, const IllustrationDescription&) = default;
};

/// How the light is computed.
struct RenderDescription {
  Integrator integrator = Integrator::kPath;
  double march_step_voxels = 3;  ///< of integrators that march: in edges of the smallest voxel side, > 0
  bool march_jitter = true;      ///< ray-march: rays begin anywhere in the first step, else in its middle
  int virtual_lights = 1024;     ///< vpl-dvr: light particles traced, each leaving one or more
  double virtual_light_radius = 0.05;  ///< vpl-dvr: nearer ones count as this far; of the visible radius, > 0
  std::uint64_t seed = 0;
  std::uint32_t frame = 0;
  int max_scatter = 2;               ///< 0 is without limit, ended by Russian roulette
  std::string accelerator = "auto";  ///< auto none macrocell octree hierarchy residency; auto is hierarchy
  int macrocell_voxels = 0;          ///< edge of the finest cells; 0 chooses
  /// What joins the hierarchy's cells to larger ones: their "cost", or "thresholds" of their majorant.
  std::string hierarchy_rule = "cost";
  double lookup_cost = 2.5;  ///< rule cost: a data look-up in units of a cell crossing
  /// Rule thresholds, in collisions over a finest cell's edge: thinner cells are left for larger ones, larger
  /// ones that are denser for their parts.
  std::array<double, 2> hierarchy_thresholds{0.1, 1};
  Sampler sampler = Sampler::kSobol;
  int light_samples = 1;  ///< shadow rays at the first scattering of a path
  TransmittanceEstimator transmittance = TransmittanceEstimator::kRatio;
  FreeFlightSampling free_flight = FreeFlightSampling::kDelta;
  Extinction extinction = Extinction::kSingle;
  /// Shadow rays that can add less than this many times the path's first one are cast by Russian roulette.
  double shadow_roulette = 0;
  std::string simd = "auto";     ///< auto scalar
  std::string denoise = "none";  ///< none, or a denoiser (docs/denoising.md)
  /// Which techniques gather light at a scattering: "mis" (both), "light" (next-event estimation alone) or
  /// "direction" (direction sampling alone, which never finds point and directional lights).
  std::string light_sampling = "mis";
  friend bool operator==(const RenderDescription&, const RenderDescription&) = default;
};

/// A field's value as a scene file writes it: a number, true or false, a word or "#rrggbb", a list of numbers
/// (of a colour: sRGB), a linear colour, the points of a transfer function.
using FieldValue =
    std::variant<double, bool, std::string, std::vector<double>, Color, std::vector<TransferPoint>>;

/// The value of a field at a time. In files [time_s, value].
struct AnimationKey {
  double time_s = 0;
  FieldValue value;
  friend bool operator==(const AnimationKey&, const AnimationKey&) = default;
};

/// Smooth: a monotone cubic through the keys that starts and ends at rest. Words and switches always step.
enum class Interpolation { kLinear, kSmooth, kStep };

/// The course of one field. Before the first key and after the last it stands still.
struct AnimationTrack {
  std::string field;  ///< its JSON pointer, "/camera/azimuth_deg" or "/lights/0/position_mm"
  Interpolation interpolation = Interpolation::kLinear;
  std::vector<AnimationKey> keys;  ///< at least one, sorted by time; of two at one time the later one holds
  friend bool operator==(const AnimationTrack&, const AnimationTrack&) = default;
};

/// The camera's way around its target, on top of what the tracks say.
struct TurntableDescription {
  double seconds = 6;  ///< of all turns together; > 0
  double turns = 1;    ///< negative goes toward the patient's right
  friend bool operator==(const TurntableDescription&, const TurntableDescription&) = default;
};

/// What changes from frame to frame. Frame k shows the time k / fps.
struct AnimationDescription {
  double fps = 30;            ///< frames a second; > 0
  std::optional<int> frames;  ///< absent: the turntable's seconds, else up to and with the last key
  std::optional<TurntableDescription> turntable;
  std::vector<AnimationTrack> tracks;
  friend bool operator==(const AnimationDescription&, const AnimationDescription&) = default;
};

constexpr int kSceneVersion = 1;

struct SceneDescription {
  int version = kSceneVersion;
  VolumeDescription volume;
  std::vector<ProxyDescription> proxies;  ///< at most three
  TransferDescription transfer;
  std::optional<LabelsDescription> labels;
  std::vector<NamedMaterialDescription> materials;
  std::optional<IllustrationDescription> illustration;  ///< absent: light transport
  std::optional<VisibilityDescription> visibility;      ///< absent: matter is as opaque as it is
  MaterialDescription material;
  std::optional<std::vector<LightDescription>> lights;  ///< absent: the default lights; [] is none
  std::optional<EnvironmentDescription> environment;    ///< absent: the default one
  std::optional<BackgroundDescription> background;
  CameraDescription camera;
  std::optional<ClipDescription> clip;
  ImageDescription image;
  RenderDescription render;
  std::optional<AnimationDescription> animation;  ///< absent: a still picture
  friend bool operator==(const SceneDescription&, const SceneDescription&) = default;
};

}  // namespace voxlume
