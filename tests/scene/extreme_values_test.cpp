// Every number of a scene at its extremes: either the field itself is refused, by its own address, when the
// scene is resolved, or there is a picture.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "film/film.h"
#include "grid/volume_statistics.h"
#include "integrator/path_tracer.h"
#include "scene/animation.h"
#include "scene/compile.h"
#include "scene/field_types.h"
#include "scene/resolve.h"
#include "scene/scene_file.h"
#include "support/volumes.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using nlohmann::json;

constexpr int kSide_px = 16;

/// A number of a scene: where it is, and what it may be.
struct NumberField {
  std::string pointer;
  NumberRange range;
};

/// All numbers in `value`, which is at `pointer`, by the field tables.
struct NumberList {
  std::vector<NumberField> out;

  template <class T>
  void add(const T& value, const FieldInfo& info, const std::string& pointer) {
    if constexpr (OptionalField<T>) {
      if (value) add(*value, info, pointer);
    } else if constexpr (StructField<T>) {
      visit_fields(
          [&](const FieldInfo& inner, auto member) { add(value.*member, inner, pointer + "/" + inner.key); },
          Struct<T>{});
    } else if constexpr (std::is_same_v<T, AnimationKey>) {
      out.push_back({pointer + "/0", info.range});
      if (std::holds_alternative<double>(value.value)) out.push_back({pointer + "/1", {}});
    } else if constexpr (ListField<T> || TupleField<T>) {
      for (std::size_t i = 0; i < value.size(); ++i) add(value[i], info, pointer + "/" + std::to_string(i));
    } else if constexpr (std::is_same_v<T, Color>) {
      out.push_back({pointer + "/linear/1", info.range});
    } else if constexpr (std::is_arithmetic_v<T> && !std::is_same_v<T, bool>) {
      out.push_back({pointer, info.range});
    }
  }
};

TransferPoint point(double value, double opacity) {
  TransferPoint out;
  out.value = value;
  out.opacity = opacity;
  return out;
}

/// A scene of many fields; what does not go together is in others.
SceneDescription rich_scene() {
  SceneDescription s;
  s.volume.path = "noise";
  s.proxies.resize(2);
  s.proxies[0].name = "edges";
  s.proxies[0].kind = ProxyKind::kGradient;
  s.proxies[1].name = "soft";
  s.proxies[1].kind = ProxyKind::kSmoothed;
  TransferPoint dense = point(500, 0.9);
  dense.color = Color{{0.8f, 0.5f, 0.3f}};
  dense.emission = Color{{0.1f, 0.1f, 0}};
  dense.roughness = dense.metallic = dense.specular = dense.surface_share = 0.5;
  dense.anisotropy = 0.3;
  dense.extinction_color = Color{{1, 0.5f, 1}};
  s.transfer.reference_length_mm = 2;
  s.transfer.points = {point(-200, 0), dense, point(900, 0.4)};
  RuleDescription plane;
  plane.volume = "soft";
  plane.along = "edges";
  plane.columns = {{10, {point(-100, 0), point(100, 0.6)}}, {200, {point(0, 0.2)}}};
  RuleDescription steps;
  steps.kind = RuleKind::kMaterialSteps;
  TransferPoint shell;
  shell.value = 300;
  shell.material = "shell";
  steps.points = {shell};
  s.transfer.rules = {plane, steps};
  NamedMaterialDescription material;
  material.name = "shell";
  material.mu_t_per_mm = 0.7;
  material.color = material.emission = material.extinction_color = Color{{0.5f, 0.5f, 0.5f}};
  material.roughness = material.metallic = material.specular = material.surface_share = 0.4;
  material.transmission = material.diffuse_roughness = material.back_share = 0.3;
  material.anisotropy = material.back_anisotropy = 0.2;
  material.ior = 1.4;
  s.materials = {material};
  LightDescription sun, lamp, panel;
  sun.direction = Double3{-0.5, 0.6, 0.75};
  lamp.kind = LightKind::kPoint;
  lamp.position_mm = Double3{10, 20, 30};
  lamp.intensity = 500;
  panel.kind = LightKind::kRect;
  panel.attached_to = Attachment::kCamera;
  panel.position_mm = Double3{10, 20, 30};
  panel.target_mm = Double3{0, 1, 0};
  panel.up = Double3{0, 0, 1};
  panel.size_mm = {30, 40};
  s.lights = {sun, lamp, panel};
  s.environment.emplace();
  s.background.emplace();
  s.camera.target_mm = Double3{1, 2, 3};
  s.camera.focus_mm = 30;
  s.camera.aperture_radius_mm = 0.1;
  s.camera.fit_radius_mm = 7;
  s.clip = ClipDescription{{-3, 4}, {-3, 3}, {-4, 3}, false};
  s.image.spp = 1;
  s.image.seconds = 5;
  s.image.noise = 0.1;
  s.image.width = s.image.height = kSide_px;
  s.animation.emplace();
  s.animation->frames = 3;
  s.animation->turntable.emplace();
  s.animation->tracks = {{"/camera/zoom", Interpolation::kSmooth, {{0, 1.0}, {2.5, 2.0}}}};
  return s;
}

/// An eye of its own, extinctions, what is important.
SceneDescription eye_scene() {
  SceneDescription s;
  s.volume.path = "noise";
  s.transfer.points.resize(2);
  s.transfer.points[0].value = -100;
  s.transfer.points[0].mu_t_per_mm = 0.1;
  s.transfer.points[1].value = 400;
  s.transfer.points[1].mu_t_per_mm = 2;
  s.transfer.density_scale = 2;
  s.camera.eye_mm = Double3{5, -40, 6};
  s.camera.up = Double3{0, 0.1, 1};
  s.visibility.emplace();
  s.visibility->light_samples = 20;
  s.visibility->ray_passes = 2;
  s.visibility->lights = VisibilityLights::kFirst;
  ImportanceDescription values, ball, box;
  values.range = std::array<double, 2>{300, 1000};
  values.along = "data";
  values.along_range = std::array<double, 2>{0, 1000};
  ball.center_mm = box.center_mm = Double3{1, 1, 1};
  ball.radius_mm = 2;
  box.size_mm = Double3{1, 2, 3};
  s.visibility->important = {values, ball, box};
  s.image.spp = 1;
  s.image.width = s.image.height = kSide_px;
  return s;
}

SceneDescription flat_scene() {
  SceneDescription s = eye_scene();
  s.visibility.reset();
  s.camera = {};
  s.camera.projection = Projection::kOrthographic;
  s.camera.height_mm = 12;
  s.render.integrator = Integrator::kRayMarch;
  s.illustration.emplace();
  s.illustration->ramp = {point(-0.5, 1), point(0.5, 1)};
  s.illustration->ramp[0].color = Color{{0, 0, 1}};
  return s;
}

/// Whether `where`, a message's address, is that of the number or of the vector it belongs to. Of lists that
/// are sorted a neighbour is as much to blame.
bool is_own(const std::string& where, const std::string& pointer) {
  std::string own = pointer;
  for (;;) {
    if (where == own) return true;
    const std::size_t slash = own.rfind('/');
    const std::string last = own.substr(slash + 1);
    const bool part = last == "linear" ||
                      std::all_of(last.begin(), last.end(), [](unsigned char c) { return std::isdigit(c); });
    if (!part) break;
    own.erase(slash);
  }
  // A light that has been moved may come to face the way that is up to it.
  if (where == "/lights/2/up") return pointer.starts_with("/lights/2/");
  for (const char* key : {"/points/", "/columns/", "/keys/", "/ramp/"})
    if (const std::size_t list = pointer.rfind(key); list != std::string::npos)
      return where.starts_with(pointer.substr(0, list) + key);
  return false;
}

class ExtremeValues : public testing::TestWithParam<std::function<SceneDescription()>> {
 protected:
  /// The refusal's address, empty where there is a picture. Anything else fails the test.
  std::string outcome(const json& scene, const std::string& what) {
    SceneDescription resolved;
    try {
      resolved = resolve(parse_scene(scene.dump(), "s"), volume_, statistics_);
      if (resolved.animation) resolved = resolve(scene_at(resolved, 1), volume_, statistics_);
    } catch (const Error& error) {
      const std::string where = error.where().starts_with("s: ") ? error.where().substr(3) : error.where();
      return where.empty() ? "nowhere" : where;
    }
    // Sizes alone say nothing about the picture, and this one is to be small.
    resolved.image.width = resolved.image.height = kSide_px;
    try {
      if (compiled_)
        compiled_->update(resolved);
      else
        compiled_.emplace(resolved, volume_, statistics_);
      Film film(kSide_px, kSide_px, {});
      TraceCounters counters;
      render_tile(compiled_->view(), {0, 0, kSide_px, kSide_px}, 0, 1, film, counters);
      EXPECT_EQ(film.total_samples(), std::uint64_t{kSide_px} * kSide_px);
      EXPECT_EQ(film.nonfinite_samples(), 0u) << what;
    } catch (const std::exception& error) {
      ADD_FAILURE() << what << ": accepted, then " << error.what();
    }
    return "";
  }

  const Volume volume_ = test::noise_volume<std::int16_t>({8, 7, 6}, -1000, 1000, 1);
  const VolumeStatistics statistics_ = compute_statistics(make_grid_view(volume_));
  std::optional<CompiledScene> compiled_;  ///< of the last picture
};

TEST_P(ExtremeValues, AreRefusedByTheirAddressOrMakeAPicture) {
  const SceneDescription scene = GetParam()();
  ASSERT_EQ(outcome(json::parse(write_scene(scene, true)), "as it is"), "");
  NumberList numbers;
  numbers.add(scene, {.key = "", .doc = ""}, "");
  ASSERT_GT(numbers.out.size(), 40u);
  const json text = json::parse(write_scene(scene, true));
  int pictures = 0, refusals = 0;
  for (const NumberField& field : numbers.out) {
    if (field.pointer == "/version" || field.pointer.starts_with("/volume/")) continue;
    const bool whole = text.at(json::json_pointer(field.pointer)).is_number_integer();
    std::set<double> values{0, 1, 1e-300, 1e-9, -1e-9, 1e6, 1e9, -1e9, 1e12, -1e12, 1e30};
    for (const double bound : {field.range.lower, field.range.upper}) values.insert(bound);
    for (const double value : values) {
      json spoilt = text;
      if (whole && value == std::floor(value) && std::abs(value) < 9e15)
        spoilt[json::json_pointer(field.pointer)] = static_cast<std::int64_t>(value);
      else
        spoilt[json::json_pointer(field.pointer)] = value;
      const std::string what = field.pointer + " = " + std::to_string(value);
      SCOPED_TRACE(what);
      const std::string where = outcome(spoilt, what);
      EXPECT_TRUE(where.empty() || is_own(where, field.pointer)) << what << " is refused at " << where;
      ++(where.empty() ? pictures : refusals);
    }
  }
  EXPECT_GT(pictures, 150);
  EXPECT_GT(refusals, 100);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExtremeValues, testing::Values(rich_scene, eye_scene, flat_scene));

TEST(ExtremeValue, AClipBoxThatKeepsNothingIsRefusedAtItsSide) {
  const Volume volume = test::noise_volume<std::int16_t>({8, 7, 6}, -1000, 1000, 1);
  SceneDescription scene = eye_scene();
  scene.clip = ClipDescription{{-3, 4}, {-3, 3}, {500, 600}, false};
  try {
    resolve(scene, volume, compute_statistics(make_grid_view(volume)));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.where(), "/clip/z_mm");
  }
}

}  // namespace
}  // namespace voxlume
