#include "scene/compile.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <tuple>

#include "base/progress_parts.h"
#include "camera/camera.h"
#include "grid/grid_view.h"
#include "image_io/image_io.h"
#include "scene/check_picture.h"
#include "scene/label_values.h"
#include "scene/peers.h"
#include "scene/recenter.h"
#include "scene/resolve.h"
#include "scene/tracking_choice.h"
#include "voxlume/error.h"
#include "voxlume/volume_io.h"

namespace voxlume {
namespace {

constexpr std::size_t kMaxLabel = 1u << 20;

Vec3f to_vec(const Color& color) { return {color.linear[0], color.linear[1], color.linear[2]}; }

SimdTarget simd_target(const std::string& name) {
  if (name == "auto") return best_simd_target();
  std::string available = "auto";
  for (const SimdTarget target :
       {SimdTarget::kScalar, SimdTarget::kSse4, SimdTarget::kAvx2, SimdTarget::kAvx512, SimdTarget::kNeon}) {
    if (!has_simd_target(target)) continue;
    if (name == simd_name(target)) return target;
    available += std::string(", ") + simd_name(target);
  }
  throw Error(ErrorCode::kUnsupported, "/render/simd",
              "this machine has no \"" + name + "\"; available: " + available);
}

/// A label volume and its colours, read and checked.
struct LabelSet {
  Volume volume;
  LabelTable table;
};

LabelSet read_labels(const LabelsDescription& labels, const Double3& origin_mm) {
  LabelSet out{read_volume(labels.path), {}};
  const GridView grid = make_grid_view(moved_to_origin(out.volume, origin_mm));
  const std::vector<float> values = label_values(grid, labels.path);
  const auto count = values.empty() ? 1 : static_cast<std::size_t>(std::max(values.back(), 0.0f)) + 1;
  if (count > kMaxLabel + 1)
    throw Error(
        ErrorCode::kBadFormat, labels.path,
        "expected labels up to " + std::to_string(kMaxLabel) + ", found " + std::to_string(count - 1));
  out.table = read_label_table(labels.path, labels.names, count);
  return out;
}

/// Throws where matter of greatest extinction mu_t [1/mm] cannot be tracked through.
void check_depth(float mu_t, const Volume& volume) {
  const double voxel_depth = double{mu_t} * make_grid_view(volume).step_mm;
  if (voxel_depth > kMostVoxelDepth)
    throw Error(ErrorCode::kBadParameter, "/transfer",
                "its densest matter has an optical depth of " + std::to_string(voxel_depth) +
                    " in one voxel; expected at most 100000");
}

/// All that the choice of an accelerator depends on besides the volume.
auto accelerator_fields(const RenderDescription& render) {
  return std::tie(render.accelerator, render.macrocell_voxels, render.hierarchy_rule, render.lookup_cost,
                  render.hierarchy_thresholds, render.transmittance, render.free_flight);
}

/// When a file was written last; the least of times where it is not there.
std::filesystem::file_time_type file_time(const std::string& path) {
  std::error_code failed;
  return std::filesystem::last_write_time(path, failed);
}

/// Whether a file is there that is not the one of that time.
bool is_other_file(const std::string& path, std::filesystem::file_time_type time) {
  const auto now = file_time(path);
  return now != time && now != std::filesystem::file_time_type::min();
}

LightSampling light_sampling(const std::string& name) {
  if (name == "mis") return LightSampling::kMis;
  if (name == "light") return LightSampling::kLight;
  if (name == "direction") return LightSampling::kDirection;
  throw Error(ErrorCode::kBadParameter, "/render/light_sampling",
              "unknown \"" + name + "\"; expected mis, light or direction");
}

}  // namespace

/// What of a scene was compiled anew and may not be, for want of a change.
struct CompiledScene::Parts {
  std::optional<TransferFunction> transfer;
  std::optional<ExtinctionColorCurve> extinction_color;
  std::optional<Accelerator> accelerator;
  std::optional<LabelSet> labels;
  std::optional<RuleVolumes> rule_volumes;
  std::optional<Classifier> classifier;
  std::optional<Materials> materials;
};

CompiledScene::CompiledScene(SceneDescription description, Volume volume, const VolumeStatistics& statistics,
                             const ListProgress& progress)
    : volume_(std::move(volume)),
      origin_mm_(visible_sphere(volume_, std::nullopt).center_mm),
      statistics_{
          statistics.lower, statistics.upper, statistics.nonfinite_voxels, statistics.gradient_p999, {}} {
  if (!std::isfinite(statistics.lower) || !std::isfinite(statistics.upper))
    throw Error(ErrorCode::kUnsupported, description.volume.path,
                "its values exceed what a 32-bit float holds, in which voxlume computes; rescale them");
  compile(std::move(description), true, progress);
}

void CompiledScene::update(SceneDescription description, const ListProgress& progress) {
  description.volume = description_.volume;
  compile(std::move(description), false, progress);
}

void CompiledScene::compile(SceneDescription description, bool everything, const ListProgress& progress) {
  const SceneDescription local = moved_to_origin(description, origin_mm_);
  const BoundingSphere visible = visible_sphere(moved_to_origin(volume_, origin_mm_), local.clip);
  const SceneSphere sphere{Vec3f(Vec3d(visible.center_mm[0], visible.center_mm[1], visible.center_mm[2])),
                           static_cast<float>(visible.radius_mm)};
  const bool same_proxies = !everything && description.proxies == description_.proxies;
  const bool has_lists = local.visibility && !local.visibility->important.empty();
  const int long_parts = has_lists && !same_proxies && !description.proxies.empty() ? 2 : 1;
  // What can fail comes first; from put_medium on, nothing does but for want of memory.
  Parts parts = compile_parts(description, everything, part_of(progress, 0, long_parts));
  std::optional<ImportanceField> importance =
      compile_importance(local, (parts.rule_volumes ? *parts.rule_volumes : *rule_volumes_).volumes(),
                         !everything && same_importance(description, description_));
  const CameraView camera =
      compile_camera(local.camera, sphere.center_mm, sphere.radius_mm, local.image.width, local.image.height);
  compile_lights(local, everything, camera, sphere);
  view_.camera = camera;
  put_medium(parts, local);
  put_scattering(parts, description);
  put_illustration(description);
  put_image(description);
  put_integrator(local, sphere, !everything && same_light(description, description_));
  const bool same_lists = !everything && same_pixel_lists(description, description_);
  description_ = std::move(description);
  // Last: it can be ended half way.
  put_visibility(std::move(importance), local, same_lists, part_of(progress, long_parts - 1, long_parts));
}

CompiledScene::Parts CompiledScene::compile_parts(const SceneDescription& description, bool everything,
                                                  const Progress& progress) const {
  const RenderDescription& render = description.render;
  simd_target(render.simd);
  check_trackers(description);
  Parts parts;
  if (everything || !(description.transfer == description_.transfer)) {
    parts.transfer.emplace(description.transfer);
    parts.extinction_color.emplace(description.transfer.points);
    check_depth(parts.transfer->max_mu_t(), volume_);
  }
  const GridView grid = make_grid_view(volume_);
  check_march_steps(render, grid);
  const AcceleratorChoice accelerator = accelerator_choice(description, grid);
  if (everything || accelerator_fields(render) != accelerator_fields(description_.render))
    parts.accelerator.emplace(grid, accelerator);
  compile_rules(description, everything, parts, progress);
  const auto& labels = description.labels;
  if (labels && (everything || !description_.labels || labels->path != description_.labels->path ||
                 labels->names != description_.labels->names))
    parts.labels = read_labels(*labels, origin_mm_);
  return parts;
}

void CompiledScene::compile_rules(const SceneDescription& description, bool everything, Parts& parts,
                                  const Progress& progress) const {
  const bool new_volumes = everything || !(description.proxies == description_.proxies);
  const bool by_opacity = description.render.integrator == Integrator::kAr2t;
  const bool new_materials = everything || !(description.materials == description_.materials) ||
                             !(description.material == description_.material) ||
                             by_opacity != (description_.render.integrator == Integrator::kAr2t);
  if (new_volumes)
    parts.rule_volumes.emplace(volume_, statistics_, description.proxies, origin_mm_, progress);
  if (!new_volumes && !new_materials && description.transfer == description_.transfer) return;
  const RuleVolumes& volumes = parts.rule_volumes ? *parts.rule_volumes : *rule_volumes_;
  const auto compile = [&](const SceneDescription& scene) {
    if (new_materials) parts.materials.emplace(scene.material, scene.materials);
    const Materials& materials = parts.materials ? *parts.materials : *materials_;
    parts.classifier.emplace(scene.transfer, volumes.volumes(), materials.named());
  };
  // First the rules as the scene has them, for what is wrong to have the scene's own numbers.
  if (!by_opacity || !description.transfer.rules.empty()) compile(description);
  if (by_opacity) compile(with_opacity_materials(description));
  if (parts.classifier->has_rules()) check_depth(parts.classifier->upper_mu_t(), volume_);
}

void CompiledScene::compile_lights(const SceneDescription& local, bool everything, const CameraView& camera,
                                   const SceneSphere& sphere) {
  const EnvironmentDescription& environment = *local.environment;
  // Directions find light through the physical extinction, which is not what shadow rays meet then.
  const bool other_shadows =
      local.material.self_occlusion < 1 || (local.visibility && !local.visibility->important.empty() &&
                                            local.visibility->lights != VisibilityLights::kOff);
  const LightSampling sampling =
      other_shadows ? LightSampling::kLight : light_sampling(local.render.light_sampling);
  const EnvironmentSamples samples = environment_samples(local.render, sampling);
  const bool same_picture =
      !everything && environment.image == description_.environment->image &&
      (environment == *description_.environment || !is_other_file(environment.image, environment_time_));
  if (same_picture) {
    lights_->update(*local.lights, environment, view_frame(camera), sphere, samples);
  } else {
    std::optional<EnvironmentImage> picture;
    const std::filesystem::file_time_type time = file_time(environment.image);
    if (!environment.image.empty()) picture = read_environment(environment.image);
    lights_ = Lights(*local.lights, environment, picture ? &*picture : nullptr, view_frame(camera), sphere,
                     samples);
    environment_time_ = time;
  }
  view_.light_sampling = sampling;
  view_.lights = lights_->view();
  view_.ambient = environment.ambient ? view_.lights.environment_mean : Vec3f(0.0f);
}

void CompiledScene::put_medium(Parts& parts, const SceneDescription& local) {
  const bool new_majorants = parts.transfer || parts.accelerator || parts.classifier;
  if (parts.transfer) transfer_ = std::move(parts.transfer);
  if (parts.extinction_color) extinction_color_ = std::move(parts.extinction_color);
  if (parts.accelerator) accelerator_.emplace(std::move(*parts.accelerator));
  if (parts.rule_volumes) {
    rule_volumes_ = std::move(parts.rule_volumes);
    accelerator_->forget_volumes();
  }
  if (parts.classifier) classifier_ = std::move(parts.classifier);
  if (new_majorants) {
    const auto start = std::chrono::steady_clock::now();
    if (classifier_->has_rules())
      accelerator_->update(make_grid_view(moved_to_origin(volume_, origin_mm_)), *classifier_);
    else
      accelerator_->update(*transfer_);
    majorant_build_ms_ =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    view_.medium = {make_grid_view(moved_to_origin(volume_, origin_mm_)),
                    transfer_->view(),
                    accelerator_->view(),
                    classifier_->view(),
                    1,
                    extinction_color_->view()};
  }
  view_.medium.shadow_extinction = static_cast<float>(local.material.self_occlusion);
  view_.simd = simd_target(local.render.simd);
  view_.trackers = tracker_choice(local.render, view_.medium.grid);
  view_.ray_march = ray_march_choice(local);
  view_.extinction = local.render.extinction;
  if (view_.extinction == Extinction::kRgb || !view_.trackers.is_default() ||
      !vector_tracker(view_.simd, view_.medium))
    view_.simd = SimdTarget::kScalar;
  view_.domain_index = view_.medium.grid.index_box();
  view_.clip_world = {Vec3f(-1e30f), Vec3f(1e30f)};
  view_.clip_blocks_light = local.clip && local.clip->blocks_light;
  if (const auto& clip = local.clip) {
    view_.clip_world = {Vec3f(Vec3d(clip->x_mm[0], clip->y_mm[0], clip->z_mm[0])),
                        Vec3f(Vec3d(clip->x_mm[1], clip->y_mm[1], clip->z_mm[1]))};
  }
  if (parts.labels) {
    label_volume_ = std::move(parts.labels->volume);
    label_table_ = std::move(parts.labels->table);
    view_.labels = {make_grid_view(moved_to_origin(*label_volume_, origin_mm_)), label_table_->colors.data(),
                    static_cast<std::int32_t>(label_table_->colors.size())};
  }
  if (!local.labels) view_.labels = {};
  if (local.labels) view_.labels.strength = static_cast<float>(local.labels->strength);
}

float CompiledScene::max_mu_t() const {
  return classifier_->has_rules() ? classifier_->upper_mu_t()
                                  : transfer_->max_mu_t(statistics_.lower, statistics_.upper);
}

void CompiledScene::put_scattering(Parts& parts, const SceneDescription& description) {
  const MaterialDescription& material = description.material;
  if (parts.materials) materials_ = std::move(parts.materials);
  ScatteringView& out = view_.scattering;
  out.particles = material.lobes == LobeModel::kParticles ||
                  (material.lobes == LobeModel::kAuto &&
                   (!description.materials.empty() || classifier_->gives_numbers()));
  out.materials = materials_->views();
  view_.shades_singly = out.particles || classifier_->has_rules() || description.illustration ||
                        material.shading == Shading::kBlinnPhong;
  out.shading = material.shading;
  out.surface_share = material.surface_share;
  out.gradient_factor = static_cast<float>(material.gradient_factor);
  out.opacity_modulated = material.opacity_modulated;
  out.g = static_cast<float>(material.anisotropy);
  out.alpha = static_cast<float>(material.roughness * material.roughness);
  out.f0 = kMostDielectricF0 * static_cast<float>(material.specular);
  out.inverse_gradient_scale = 1.0f / statistics_.gradient_p999;
  const float most_mu_t = max_mu_t();
  out.highlight_mm2 =
      most_mu_t > 0 ? static_cast<float>(material.highlight) * view_.medium.grid.step_mm / most_mu_t : 0.0f;
  out.shininess = static_cast<float>(material.shininess);
  // What stands for a pixel has at least a quarter of the greatest extinction in the volume (xu2024 5.2).
  view_.dense_mu_t = 0.25f * most_mu_t;
}

void CompiledScene::put_illustration(const SceneDescription& description) {
  IllustrationView& out = view_.illustration;
  out = {};
  if (!description.illustration) return;
  const IllustrationDescription& illustration = *description.illustration;
  TransferDescription ramp;
  ramp.reference_length_mm = 1;
  ramp.points = illustration.ramp;
  const auto tone = [](double cosine, Color color) {
    TransferPoint point;
    point.value = cosine;
    point.color = color;
    return point;
  };
  if (ramp.points.empty())
    ramp.points = {tone(-0.6, {{0.05f, 0.07f, 0.2f}}), tone(0.2, {{0.3f, 0.28f, 0.34f}}),
                   tone(0.95, {{1.0f, 0.92f, 0.72f}})};
  for (TransferPoint& point : ramp.points) {
    point.opacity.reset();
    point.mu_t_per_mm = 1;
  }
  ramp_.emplace(ramp);
  out.on = true;
  out.ramp = ramp_->view();
  const Double3& d = illustration.direction;
  Vec3f to_light(Vec3d(d[0], d[1], d[2]));
  if (illustration.attached_to == Attachment::kCamera) {
    const ViewFrame frame = view_frame(view_.camera);
    to_light = frame.right * to_light.x + frame.up * to_light.y + frame.toward_eye * to_light.z;
  }
  out.to_light = normalize(to_light);
  out.contour = static_cast<float>(illustration.contour);
  out.contour_width = static_cast<float>(illustration.contour_width);
  out.contour_color = to_vec(illustration.contour_color);
}

void CompiledScene::put_image(const SceneDescription& description) {
  const ImageDescription& image = description.image;
  const RenderDescription& render = description.render;
  view_.background = description.background->kind;
  view_.background_color = to_vec(description.background->color);
  view_.width = image.width;
  view_.height = image.height;
  view_.filter = image.filter;
  view_.filter_radius_px = static_cast<float>(image.filter_radius_px);
  view_.seed = render.seed;
  view_.frame = render.frame;
  view_.max_scatter = render.max_scatter;
  view_.sampler = render.sampler;
  view_.light_samples = render.light_samples;
  view_.shadow_roulette = static_cast<float>(render.shadow_roulette);
  view_.matter_emits = classifier_->has_rules() ? classifier_->emits() : transfer_->emits();
  view_.last_flight_collects =
      view_.matter_emits || (view_.light_sampling != LightSampling::kLight &&
                             (view_.lights.has_environment || view_.lights.rect_count > 0));
}

std::vector<std::string> CompiledScene::warnings() const {
  std::vector<std::string> out = rule_volumes_->warnings();
  if (description_.labels) {
    out.insert(out.end(), label_volume_->warnings.begin(), label_volume_->warnings.end());
    if (intersect(world_bounds(*label_volume_), world_bounds(volume_)).empty())
      out.push_back("/labels: they lie nowhere in the volume, and so colour nothing");
  }
  const float magnitude = std::max(std::abs(statistics_.lower), std::abs(statistics_.upper));
  if (voxel_bytes(volume_.type) > 2 && statistics_.upper > statistics_.lower &&
      statistics_.upper - statistics_.lower < 1e-5f * magnitude)
    out.push_back(
        "the values differ by little more than the precision of a 32-bit float; subtract their mean");
  if (statistics_.nonfinite_voxels > 0)
    out.push_back(std::to_string(statistics_.nonfinite_voxels) +
                  " voxels are not finite and stay transparent");
  if (!(max_mu_t() > 0))
    out.push_back("nothing is visible: the transfer function is 0 for every value of the volume");
  return out;
}

}  // namespace voxlume
