#include "cli/scene_flags.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "base/file_extension.h"
#include "scene/field_types.h"
#include "scene/scene_file.h"
#include "voxlume/error.h"
#include "voxlume/volume_io.h"

namespace voxlume::cli {
namespace {

using Apply = void (*)(SceneDescription& scene, const std::string& text, const std::string& flag);

/// A flag and the field it sets. Its help is the field's own unless `help` says more.
struct Row {
  const char* flag;
  const char* value;    ///< what the help calls its value, "[...]" if it may be left out; nullptr: has none
  const char* address;  ///< field set, or that explains it
  const char* help = nullptr;
  Apply apply = nullptr;  ///< nullptr: set_scene_field(address)
};

[[noreturn]] void refuse(const std::string& flag, const std::string& text, const std::string& expected) {
  throw Error(ErrorCode::kBadParameter, flag, "found " + quote_text(text) + ", expected " + expected);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t start = 0;;) {
    const std::size_t end = text.find(separator, start);
    parts.push_back(text.substr(start, end - start));
    if (end == std::string::npos) return parts;
    start = end + 1;
  }
}

void apply_size(SceneDescription& scene, const std::string& text, const std::string& flag) {
  const auto parts = split(text, 'x');
  if (parts.size() != 2) refuse(flag, text, "WxH in pixels, such as 800x600");
  set_scene_field(scene, "/image/width", parts[0], flag);
  set_scene_field(scene, "/image/height", parts[1], flag);
}

void apply_preset(SceneDescription& scene, const std::string& text, const std::string& flag) {
  if (text.empty()) refuse(flag, text, "a name that voxlume presets lists");
  set_scene_field(scene, "/transfer/preset", text, flag);
  scene.transfer.points.clear();  // the scene's own would win over the preset's
}

void apply_camera(SceneDescription& scene, const std::string& text, const std::string& flag) {
  const auto parts = split(text, ',');
  if (parts.size() != 2 && parts.size() != 3)
    refuse(flag, text, "azimuth,elevation[,zoom], angles in degrees");
  set_scene_field(scene, "/camera/azimuth_deg", parts[0], flag);
  set_scene_field(scene, "/camera/elevation_deg", parts[1], flag);
  if (parts.size() == 3) set_scene_field(scene, "/camera/zoom", parts[2], flag);
  scene.camera.eye_mm.reset();  // would win over the angles
  scene.camera.up.reset();
}

void apply_environment(SceneDescription& scene, const std::string& text, const std::string& flag) {
  // A constant environment's colour is its radiance, and no tint for a picture.
  if (scene.environment && scene.environment->image.empty()) {
    scene.environment->color = {};
    scene.environment->intensity = 1;
  }
  set_scene_field(scene, "/environment/image", text, flag);
}

void apply_background(SceneDescription& scene, const std::string& text, const std::string& flag) {
  BackgroundDescription background;
  if (text == "env") {
    background.kind = BackgroundKind::kEnvironment;
  } else if (text == "transparent") {
    background.kind = BackgroundKind::kTransparent;
  } else if (text.starts_with('#') || split(text, ',').size() == 3) {
    scene.background = background;
    set_scene_field(scene, "/background/color", text, flag);
    return;
  } else {
    refuse(flag, text, "env, transparent, \"#rrggbb\" or R,G,B in [0, 1] (sRGB)");
  }
  scene.background = background;
}

void apply_clip(SceneDescription& scene, const std::string& text, const std::string& flag) {
  const char* const kExpected = "x0:x1,y0:y1,z0:z1 in LPS mm; either side of a colon may be empty";
  const auto parts = split(text, ',');
  if (parts.size() != 3) refuse(flag, text, kExpected);
  ClipDescription clip;
  clip.blocks_light = scene.clip && scene.clip->blocks_light;
  scene.clip = clip;
  const char* const kAddresses[] = {"/clip/x_mm/", "/clip/y_mm/", "/clip/z_mm/"};
  for (std::size_t a = 0; a < 3; ++a) {
    const auto ends = split(parts[a], ':');
    if (ends.size() != 2) refuse(flag, text, kExpected);
    for (std::size_t e = 0; e < 2; ++e) {
      if (!ends[e].empty()) set_scene_field(scene, kAddresses[a] + std::to_string(e), ends[e], flag);
    }
  }
  for (const auto& ends : {scene.clip->x_mm, scene.clip->y_mm, scene.clip->z_mm}) {
    if (!(ends[0] < ends[1])) refuse(flag, text, "the lower end first");
  }
}

void apply_labels(SceneDescription& scene, const std::string& text, const std::string& flag) {
  if (text.empty()) refuse(flag, text, "a label volume");
  set_scene_field(scene, "/labels/path", text, flag);
  scene.labels->names.clear();  // they belong to the scene's own label volume
}

void apply_raw(SceneDescription& scene, const std::string& text, const std::string& flag) {
  try {
    parse_raw_spec(text);
  } catch (const Error& error) {
    throw Error(error.code(), flag, error.message());
  }
  set_scene_field(scene, "/volume/raw", text, flag);
}

VisibilityDescription& visibility_of(SceneDescription& scene) {
  if (!scene.visibility) scene.visibility.emplace();
  return *scene.visibility;
}

/// The proxy of that name, made where it is not there.
ProxyDescription& proxy_named(SceneDescription& scene, const std::string& name) {
  for (ProxyDescription& proxy : scene.proxies)
    if (proxy.name == name) return proxy;
  scene.proxies.emplace_back();
  scene.proxies.back().name = name;
  return scene.proxies.back();
}

/// The name of the proxy that has the distance from the border of the labels of "FILE=A,B,...".
std::string distance_proxy(SceneDescription& scene, const std::string& text, const std::string& flag) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0)
    refuse(flag, text, "label:FILE=A,B,..., labels of a volume");
  const std::string path = text.substr(0, equals), numbers = text.substr(equals + 1);
  ProxyDescription& file = proxy_named(scene, "labels " + path);
  file.path = path;
  file.lookup = Lookup::kNearest;
  const std::string of = file.name, name = "labels " + numbers + " " + path;
  ProxyDescription& distance = proxy_named(scene, name);
  distance.kind = ProxyKind::kDistance;
  distance.of = of;
  const std::vector<std::string> parts = split(numbers, ',');
  distance.labels.assign(parts.size(), 0);
  const std::string address = "/proxies/" + std::to_string(&distance - scene.proxies.data()) + "/labels/";
  for (std::size_t i = 0; i < parts.size(); ++i)
    set_scene_field(scene, address + std::to_string(i), parts[i], flag);
  return name;
}

void apply_important(SceneDescription& scene, const std::string& text, const std::string& flag) {
  ImportanceDescription important;
  important.range = {-1e12, 1e12};
  const bool labels = text.starts_with("label:");
  const std::vector<std::string> ends = split(text, ':');
  if (labels) {
    important.volume = distance_proxy(scene, text.substr(6), flag);
    (*important.range)[0] = 0;  // inside
  } else if (ends.size() != 2 || text == ":") {
    refuse(flag, text, "LOWER:UPPER, a range of values, or label:FILE=A,B,...");
  }
  std::vector<ImportanceDescription>& all = visibility_of(scene).important;
  all.push_back(important);
  const std::string address = "/visibility/important/" + std::to_string(all.size() - 1) + "/range/";
  for (std::size_t e = 0; e < 2 && !labels; ++e)
    if (!ends[e].empty()) set_scene_field(scene, address + std::to_string(e), ends[e], flag);
  const std::array<double, 2>& range = *scene.visibility->important.back().range;
  if (!(range[0] <= range[1])) refuse(flag, text, "the lower end first");
}

void apply_visibility(SceneDescription& scene, const std::string& text, const std::string& flag) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != 4) refuse(flag, text, "p,q,r,lambda, such as 1,70,30,1");
  visibility_of(scene);
  const char* const kAddresses[] = {"/visibility/p", "/visibility/q", "/visibility/r", "/visibility/lambda"};
  for (std::size_t i = 0; i < 4; ++i) set_scene_field(scene, kAddresses[i], parts[i], flag);
}

void apply_visibility_lights(SceneDescription& scene, const std::string& text, const std::string& flag) {
  visibility_of(scene);
  set_scene_field(scene, "/visibility/lights", text, flag);
}

void apply_turntable(SceneDescription& scene, const std::string& text, const std::string& flag) {
  set_scene_field(scene, "/animation/turntable", "{}", flag);
  scene.animation->frames.reset();  // as many as it takes
  if (!text.empty()) set_scene_field(scene, "/animation/turntable/seconds", text, flag);
}

// The first rows are volume flags, which other commands have as well.
constexpr std::size_t kVolumeRows = 2;
constexpr Row kRows[] = {
    {"--raw", "SPEC", "/volume/raw", nullptr, apply_raw},
    {"--spacing", "X,Y,Z", "/volume/spacing_mm"},
    {"--preset", "NAME", "/transfer/preset", "Transfer function: a name that `voxlume presets` lists",
     apply_preset},
    {"--reference-length", "MM", "/transfer/reference_length_mm"},
    {"--labels", "FILE", "/labels/path", "Label volume whose colors replace the transfer function's",
     apply_labels},
    {"--size", "WxH", "/image/width", "Picture size in pixels", apply_size},
    {"--spp", "N", "/image/spp"},
    {"--seconds", "S", "/image/seconds"},
    {"--noise", "X", "/image/noise"},
    {"--seed", "N", "/render/seed"},
    {"--max-scatter", "N", "/render/max_scatter"},
    {"--integrator", "NAME", "/render/integrator",
     "path, or as another renderer would: exposure-render, rmss, vpl-dvr, ar2t, ray-march (docs/peers.md)"},
    {"--march-step", "VOXELS", "/render/march_step_voxels"},
    {"--march-jitter", "BOOL", "/render/march_jitter"},
    {"--shading", "NAME", "/material/shading",
     "coexistence, er, phase, brdf or blinn-phong: surface and medium together, one of the two by chance, "
     "one alone, or a medium with highlights"},
    {"--roughness", "R", "/material/roughness"},
    {"--anisotropy", "G", "/material/anisotropy"},
    {"--camera", "AZ,EL[,ZOOM]", "/camera/azimuth_deg",
     "Degrees; 0,0 looks at the face, azimuth grows toward the patient's left, elevation toward the head; "
     "zoom 1 fits",
     apply_camera},
    {"--projection", "NAME", "/camera/projection", "perspective or orthographic"},
    {"--fov", "DEG", "/camera/vertical_fov_deg"},
    {"--env", "FILE", "/environment/image", nullptr, apply_environment},
    {"--background", "COLOR", "/background/kind", "env, transparent, \"#rrggbb\" or R,G,B in [0, 1] (sRGB)",
     apply_background},
    {"--clip", "X0:X1,Y0:Y1,Z0:Z1", "/clip/x_mm", "Keep a box, LPS mm; either side of a colon may be empty",
     apply_clip},
    {"--clip-blocks-light", nullptr, "/clip/blocks_light"},
    {"--exposure", "EV", "/image/exposure_ev"},
    {"--tone-curve", "NAME", "/image/tone_curve", "PNG: filmic or srgb"},
    {"--aov", "LIST", "/image/aovs",
     "Further layers of an EXR: alpha,depth,normal,albedo,samples,variance, and denoise for all that "
     "denoisers read"},
    {"--light-sampling", "NAME", "/render/light_sampling",
     "mis, light or direction: how scatterings gather light"},
    {"--denoise", "NAME", "/render/denoise",
     "decoupled, svgf, asvgf, atrous, bilateral, wrls, rls, wrls-no-feature, rls-no-feature, xu2024, oidn or "
     "none: take noise out of the picture"},
    {"--simd", "NAME", "/render/simd", "auto, scalar, sse4, avx2, avx512 or neon"},
    {"--accel", "NAME", "/render/accelerator", "auto, none, macrocell, octree, hierarchy or residency"},
    {"--important", "LO:HI|label:FILE=N", "/visibility/important",
     "What to keep in view: values from LO to HI, or labels N,M,... of a label volume", apply_important},
    {"--visibility", "P,Q,R,LAMBDA", "/visibility/p",
     "How much of what is before (q) and behind (r) the important fades, against staying as it is (p); "
     "1,70,30,1",
     apply_visibility},
    {"--visibility-lights", "NAME", "/visibility/lights",
     "off, first or all: scatterings whose light rays are freed, too", apply_visibility_lights},
    {"--turntable", "[SECONDS]", "/animation/turntable", "Camera once around its target, in 6 s unless given",
     apply_turntable},
    {"--fps", "N", "/animation/fps"},
};

void apply_setting(SceneDescription& scene, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  if (equals == std::string::npos) refuse("--set", setting, "ADDRESS=VALUE, such as /material/specular=0.2");
  set_scene_field(scene, setting.substr(0, equals), setting.substr(equals + 1),
                  "--set " + setting.substr(0, equals));
}

bool is_stop_rule(const Row& row) {
  const std::string_view address = row.address;
  return address == "/image/spp" || address == "/image/seconds" || address == "/image/noise";
}

}  // namespace

void SceneFlags::add(CLI::App& command, std::size_t index) {
  const Row& row = kRows[index];
  const std::string help = row.help ? row.help : describe_scene_field(row.address);
  if (!row.value) {
    command.add_flag_function(
        row.flag,
        [this, index](std::int64_t) {
          given_.push_back({index, "true"});
        },
        help);
    return;
  }
  CLI::Option* const option = command.add_option_function<std::string>(
      row.flag,
      [this, index](const std::string& text) {
        given_.push_back({index, text});
      },
      help);
  option->type_name(row.value);
  if (*row.value == '[') option->expected(0, 1);
}

void SceneFlags::add_volume_flags_to(CLI::App& command) {
  for (std::size_t i = 0; i < kVolumeRows; ++i) add(command, i);
}

void SceneFlags::add_to(CLI::App& command) {
  for (std::size_t i = 0; i < std::size(kRows); ++i) add(command, i);
  command
      .add_option("--set", settings_,
                  "Any field of the scene by its address, such as /material/specular=0.2 or "
                  "/camera/target_mm=0,0,40; may be repeated")
      ->type_name("ADDRESS=VALUE")
      ->take_all()
      ->allow_extra_args(false);
}

bool SceneFlags::given(const std::string& flag) const {
  return std::any_of(given_.begin(), given_.end(), [&](const Given& g) { return kRows[g.row].flag == flag; });
}

void SceneFlags::apply(SceneDescription& scene) const {
  // One stop rule on the command line replaces all of the scene's.
  if (std::any_of(given_.begin(), given_.end(), [](const Given& g) { return is_stop_rule(kRows[g.row]); })) {
    scene.image.spp.reset();
    scene.image.seconds.reset();
    scene.image.noise.reset();
  }
  for (const Given& g : given_) {
    const Row& row = kRows[g.row];
    try {
      if (row.apply) {
        row.apply(scene, g.text, row.flag);
      } else {
        set_scene_field(scene, row.address, g.text, row.flag);
      }
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kUnsupported) throw;
      throw Error(error.code(), "", fmt::format("{} {}", row.flag, error.message()));
    }
  }
  for (const std::string& setting : settings_) apply_setting(scene, setting);
}

namespace {

bool is_scene_file(const std::string& input) { return lower_extension(input) == ".json"; }

/// Whether `where` is the address of a field, and not an absolute path.
bool is_scene_address(const std::string& where) {
  if (!where.starts_with('/')) return false;
  const auto keys = field_keys<SceneDescription>();
  const std::string first = where.substr(1, where.find('/', 1) - 1);
  return std::find(keys.begin(), keys.end(), first) != keys.end();
}

}  // namespace

SceneDescription scene_of_input(const std::string& input) {
  if (is_scene_file(input)) return read_scene(input);
  SceneDescription scene;
  set_scene_field(scene, "/volume/path", input, "INPUT");
  return scene;
}

void with_scene_name(const std::string& input, const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& error) {
    if (!is_scene_file(input) || !is_scene_address(error.where())) throw;
    throw Error(error.code(), input + ": " + error.where(), error.message());
  }
}

}  // namespace voxlume::cli
