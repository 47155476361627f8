#include "light/compile_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "light/rect_light.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& message) {
  throw Error(ErrorCode::kBadParameter, where, message);
}

/// Beyond these, float arithmetic on squares overflows.
constexpr double kMaxLength_mm = 1e9, kMaxEmission = 1e15;

std::string shown(double x) { return fmt::format("found {}", x); }

Vec3d checked(const Double3& v, const std::string& where) {
  for (double x : v)
    if (!(std::abs(x) <= kMaxLength_mm)) refuse(where, shown(x) + ", expected three numbers within +-1e9");
  return {v[0], v[1], v[2]};
}

void check_emission(double x, const std::string& where) {
  if (!(x >= 0 && x <= kMaxEmission)) refuse(where, shown(x) + ", expected a number in [0, 1e15]");
}

Vec3d checked_emission(const Color& color, double intensity, const std::string& where) {
  check_emission(intensity, where + "/intensity");
  for (float c : color.linear) check_emission(c, where + "/color");
  return Vec3d(color.linear[0], color.linear[1], color.linear[2]) * intensity;
}

/// Takes what a description says, in world or camera axes, to LPS.
struct Axes {
  Vec3d x, y, z, origin;
  Vec3d vector(Vec3d v) const { return x * v.x + y * v.y + z * v.z; }
  Vec3d point(Vec3d p) const { return vector(p) + origin; }
};

Axes axes_of(Attachment attached_to, const ViewFrame& camera) {
  if (attached_to == Attachment::kWorld) return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
  return {Vec3d(camera.right), Vec3d(camera.up), Vec3d(camera.toward_eye), Vec3d(camera.target_mm)};
}

/// Any unit vector perpendicular to the unit vector n.
Vec3d perpendicular(Vec3d n) {
  return normalize(cross(n, std::abs(n.x) < 0.7 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
}

void place_rect(const LightDescription& d, const Axes& axes, const ViewFrame& camera,
                const std::string& where, Light& light) {
  const Vec3d target =
      d.target_mm ? axes.point(checked(*d.target_mm, where + "/target_mm")) : Vec3d(camera.target_mm);
  const Vec3d centre = axes.point(checked(*d.position_mm, where + "/position_mm"));
  const Vec3d facing = target - centre;
  if (!(length(facing) > 1e-9))
    refuse(where + "/target_mm", "found the light's own position, expected another point");
  const Vec3d normal = normalize(facing);

  const bool from_camera = d.attached_to == Attachment::kCamera;
  const Vec3d up = axes.vector(d.up          ? checked(*d.up, where + "/up")
                               : from_camera ? Vec3d(0, 1, 0)
                                             : Vec3d(0, 0, 1));
  Vec3d width_axis = cross(up, normal);
  if (length(width_axis) <= 1e-6 * length(up)) {
    if (d.up)
      refuse(where + "/up", "found a zero vector or the direction the light faces, expected one across it");
    width_axis = perpendicular(normal);
  }
  width_axis = normalize(width_axis);
  for (double s : d.size_mm)
    if (!(s > 0 && s <= kMaxLength_mm))
      refuse(where + "/size_mm", shown(s) + ", expected two lengths in (0, 1e9]");

  light.position_mm = Vec3f(centre);
  light.direction = Vec3f(normal);
  light.axis_x = Vec3f(width_axis);
  light.axis_y = Vec3f(cross(normal, width_axis));
  light.half_width_mm = static_cast<float>(0.5 * d.size_mm[0]);
  light.half_height_mm = static_cast<float>(0.5 * d.size_mm[1]);
}

Light compile_light(const LightDescription& d, const ViewFrame& camera, const std::string& where) {
  Light light{};
  light.kind = d.kind;
  light.two_sided = d.two_sided;
  light.emission = Vec3f(checked_emission(d.color, d.intensity, where));
  const Axes axes = axes_of(d.attached_to, camera);
  if (d.kind == LightKind::kDirectional) {
    if (!d.direction)
      refuse(where + "/direction", "missing, expected the direction from the scene to the light");
    const Vec3d direction = axes.vector(checked(*d.direction, where + "/direction"));
    if (!(length(direction) > 1e-12))
      refuse(where + "/direction", "found a zero vector, expected a direction");
    light.direction = Vec3f(normalize(direction));
    return light;
  }
  if (!d.position_mm) refuse(where + "/position_mm", "missing, expected the light's position in mm");
  if (d.kind == LightKind::kPoint)
    light.position_mm = Vec3f(axes.point(checked(*d.position_mm, where + "/position_mm")));
  else
    place_rect(d, axes, camera, where, light);
  return light;
}

/// Luminance of the irradiance at the sphere's centre on a plane that faces the light, for the choice among
/// lights.
double importance(const Light& light, const SceneSphere& scene) {
  const double emission = luminance(Vec3d(light.emission));
  if (light.kind == LightKind::kDirectional) return emission;
  const Vec3d offset = Vec3d(light.position_mm) - Vec3d(scene.center_mm);
  const double radius2 = double{scene.radius_mm} * scene.radius_mm;
  const double d2 = dot(offset, offset);
  if (light.kind == LightKind::kPoint) return emission / std::max(d2, radius2);
  const RectFromPoint rect = rect_from_point(light, scene.center_mm);
  double solid_angle = rect_emits_toward(light, rect.height) ? rect_solid_angle(rect) : 0.0;
  if (d2 < radius2) solid_angle = 4.0 * light.half_width_mm * light.half_height_mm / radius2;
  return emission * std::min(solid_angle, std::numbers::pi);
}

/// By row, the share of all directions that a texel covers.
std::vector<double> texel_shares(int width, int height) {
  std::vector<double> shares(static_cast<std::size_t>(height));
  double above = 1;  // cosine of the row's upper edge
  for (int row = 0; row < height; ++row) {
    const double below = std::cos(std::numbers::pi * (row + 1) / height);
    shares[static_cast<std::size_t>(row)] = 0.5 * (above - below) / width;
    above = below;
  }
  return shares;
}

void check_sphere(const SceneSphere& scene) {
  if (!(scene.radius_mm > 0) || !std::isfinite(scene.radius_mm) || !is_finite(scene.center_mm))
    throw Error(ErrorCode::kInternal, "", "lights need a finite scene sphere of positive radius");
}

bool emits(Vec3f emission) { return max_component(emission) > 0.0f; }

/// What the environment is multiplied by, or is where it has no picture.
Vec3f emission_of(const EnvironmentDescription& environment) {
  return Vec3f(checked_emission(environment.color, environment.intensity, "/environment"));
}

}  // namespace

Lights::Lights(const std::vector<LightDescription>& lights, const EnvironmentDescription& environment,
               const EnvironmentImage* image, const ViewFrame& camera, const SceneSphere& scene,
               EnvironmentSamples samples) {
  if (image) take_image(*image);
  compile_environment(emission_of(environment), samples);
  update(lights, environment, camera, scene, samples);
}

void Lights::update(const std::vector<LightDescription>& lights, const EnvironmentDescription& environment,
                    const ViewFrame& camera, const SceneSphere& scene, EnvironmentSamples samples) {
  check_sphere(scene);
  if (!std::isfinite(environment.rotation_deg))
    refuse("/environment/rotation_deg", shown(environment.rotation_deg) + ", expected a finite angle");
  std::vector<Light> compiled;
  for (std::size_t i = 0; i < lights.size(); ++i)
    compiled.push_back(compile_light(lights[i], camera, "/lights/" + std::to_string(i)));
  std::erase_if(compiled, [](const Light& light) { return !emits(light.emission); });
  const auto rects_end = std::stable_partition(
      compiled.begin(), compiled.end(), [](const Light& light) { return light.kind == LightKind::kRect; });
  const Vec3f scale = emission_of(environment);
  if (!(scale == environment_.scale) || samples != samples_) compile_environment(scale, samples);
  rect_count_ = static_cast<int>(rects_end - compiled.begin());
  lights_ = std::move(compiled);
  turn_environment(environment, camera);
  compile_pick(scene);
}

void Lights::turn_environment(const EnvironmentDescription& d, const ViewFrame& camera) {
  Vec3d x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  if (d.attached_to == Attachment::kCamera) {
    x = Vec3d(camera.right);
    y = -Vec3d(camera.toward_eye);
    z = Vec3d(camera.up);
  }
  const double angle = d.rotation_deg * std::numbers::pi / 180.0;
  environment_.axis_x = Vec3f(x * std::cos(angle) + y * std::sin(angle));
  environment_.axis_y = Vec3f(y * std::cos(angle) - x * std::sin(angle));
  environment_.axis_z = Vec3f(z);
}

void Lights::take_image(const EnvironmentImage& image) {
  const auto width = static_cast<std::size_t>(std::max(image.width, 0));
  const auto height = static_cast<std::size_t>(std::max(image.height, 0));
  if (height == 0 || width != 2 * height || image.rgb.size() != 3 * width * height)
    refuse("/environment/image", "found " + std::to_string(image.width) + " x " +
                                     std::to_string(image.height) +
                                     " pixels, expected an equirectangular picture with width = 2 height");
  cap_versine_.resize(height + 1);
  for (std::size_t row = 0; row <= height; ++row) {
    const double s =
        std::sin(0.5 * std::numbers::pi * static_cast<double>(row) / static_cast<double>(height));
    cap_versine_[row] = static_cast<float>(2.0 * s * s);
  }
  environment_.width = image.width;
  environment_.height = image.height;
  texels_.resize(width * height);
  for (std::size_t i = 0; i < texels_.size(); ++i)
    texels_[i] = max(Vec3f(image.rgb[3 * i], image.rgb[3 * i + 1], image.rgb[3 * i + 2]), Vec3f(0.0f));
}

void Lights::compile_environment(Vec3f scale, EnvironmentSamples samples) {
  mean_environment_ = texels_.empty() ? scale : mean_radiance(scale);
  environment_.scale = scale;
  samples_ = samples;
  has_environment_ = emits(mean_environment_);
  if (texels_.empty())
    sampled_environment_ = samples == EnvironmentSamples::kExcess ? 0.0 : luminance(Vec3d(scale));
  else
    compile_choice();
}

Vec3f Lights::mean_radiance(Vec3f scale) const {
  const auto width = static_cast<std::size_t>(environment_.width);
  const std::vector<double> share = texel_shares(environment_.width, environment_.height);
  Vec3d mean(0.0);
  for (std::size_t i = 0; i < texels_.size(); ++i) {
    const Vec3f radiance = scale * texels_[i];
    if (!is_finite(radiance))
      refuse("/environment/image", "found a non-finite value at column " + std::to_string(i % width) +
                                       ", row " + std::to_string(i / width) + ", expected finite radiance");
    mean += Vec3d(radiance) * share[i / width];
  }
  return Vec3f(mean);
}

void Lights::compile_choice() {
  const auto width = static_cast<std::size_t>(environment_.width);
  const double left_out = samples_ == EnvironmentSamples::kExcess ? luminance(Vec3d(mean_environment_)) : 0.0;
  const std::vector<double> share = texel_shares(environment_.width, environment_.height);
  std::vector<double> weights(texels_.size());
  sampled_environment_ = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const Vec3f radiance = environment_.scale * texels_[i];
    weights[i] = share[i / width] * std::max(0.0, luminance(Vec3d(radiance)) - left_out);
    sampled_environment_ += weights[i];
    if (samples_ == EnvironmentSamples::kUniform) weights[i] = share[i / width];
  }
  texel_choice_ = Distribution2D(weights, environment_.width, environment_.height);
}

void Lights::compile_pick(const SceneSphere& scene) {
  std::vector<double> weights;
  for (const Light& light : lights_) weights.push_back(importance(light, scene));
  weights.push_back(std::numbers::pi * sampled_environment_);
  const bool environment_sampled = sampled_environment_ > 0;
  const double count = static_cast<double>(lights_.size()) + (environment_sampled ? 1.0 : 0.0);
  pick_ = {};
  if (count == 0) return;
  double total = 0;
  for (double w : weights) total += w;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const bool emitting = i < lights_.size() || environment_sampled;
    const double share = total > 0 ? weights[i] / total : 0.0;
    const double probability =
        samples_ == EnvironmentSamples::kUniform ? 1 / count : 0.9 * share + 0.1 / count;
    weights[i] = emitting ? probability : 0.0;
  }
  pick_ = Distribution1D(weights);
}

LightsView Lights::view() const {
  LightsView out;
  out.lights = lights_.data();
  out.light_count = static_cast<int>(lights_.size());
  out.rect_count = rect_count_;
  out.has_environment = has_environment_;
  out.environment = environment_;
  out.environment_mean = mean_environment_;
  out.environment.texels = texels_.data();
  out.environment.cap_versine = cap_versine_.data();
  out.environment.choice = texel_choice_.view();
  out.pick = pick_.view();
  return out;
}

}  // namespace voxlume
