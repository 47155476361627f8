#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "scene/field_types.h"
#include "scene/scene_file.h"
#include "scene/scene_schema.h"
#include "scene/validate.h"
#include "scene_examples.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using testing::HasSubstr;

std::string text_of(const std::string& name) {
  std::ifstream file(std::string(VOXLUME_SOURCE_DIR) + "/" + name);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(SceneSchema, TheCommittedCopyIsCurrent) {
  EXPECT_EQ(scene_schema(), text_of("docs/scene.schema.json")) << "voxlume schema > docs/scene.schema.json";
}

TEST(SceneReference, TheCommittedCopyIsCurrent) {
  EXPECT_EQ(scene_reference_markdown(), text_of("docs/scene-reference.md"))
      << "voxlume schema --markdown > docs/scene-reference.md";
}

TEST(SceneSchema, EveryReferenceLeadsToADefinition) {
  const auto schema = nlohmann::json::parse(scene_schema());
  EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
  int references = 0;
  const std::function<void(const nlohmann::json&)> walk = [&](const nlohmann::json& value) {
    if (value.is_object() && value.contains("$ref")) {
      ++references;
      EXPECT_TRUE(schema.contains(nlohmann::json::json_pointer(value["$ref"].get<std::string>().substr(1))))
          << value;
    }
    if (value.is_structured()) {
      for (const auto& element : value) walk(element);
    }
  };
  walk(schema);
  EXPECT_GT(references, 10);
}

TEST(SceneReference, TheExampleIsAValidScene) {
  const std::string page = scene_reference_markdown();
  const std::size_t start = page.find("```json\n") + 8;
  const SceneDescription s = parse_scene(page.substr(start, page.find("```", start) - start), "example");
  EXPECT_EQ(s.image.spp, 256);
}

/// Every field of `full` but `except` differs from its default: what the round-trip tests rely on.
template <StructField T>
void expect_no_defaults(const T& full, const std::set<std::string>& except = {}) {
  visit_fields(
      [&](const FieldInfo& info, auto member) {
        EXPECT_EQ(full.*member == T{}.*member, except.contains(info.key)) << info.key;
      },
      Struct<T>{});
}

TEST(FullScene, HasNoDefaults) {
  const SceneDescription s = full_scene();
  expect_no_defaults(s, {"version"});
  expect_no_defaults(s.volume);
  expect_no_defaults(s.transfer);
  expect_no_defaults(*s.labels);
  expect_no_defaults(s.material);
  expect_no_defaults(s.lights->back(), {"color", "intensity", "direction"});
  expect_no_defaults(s.lights->front(),
                     {"kind", "attached_to", "position_mm", "target_mm", "up", "size_mm", "two_sided"});
  expect_no_defaults(*s.environment);
  expect_no_defaults(*s.background);
  expect_no_defaults(s.camera);
  expect_no_defaults(*s.clip);
  expect_no_defaults(s.image);
  expect_no_defaults(s.render);
  expect_no_defaults(*s.animation);
  expect_no_defaults(*s.animation->turntable);
  expect_no_defaults(s.animation->tracks.front());
}

/// All fields of T are distinct and documented.
template <StructField T>
void expect_complete_table() {
  std::vector<std::string_view> keys = field_keys<T>();
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
  visit_fields(
      [&]<class M>(const FieldInfo& info, M T::*) {
        EXPECT_GT(std::string(info.doc).size(), 3u) << info.key;
        EXPECT_EQ(OptionalField<M>, *info.absent != '\0') << info.key;
      },
      Struct<T>{});
}

TEST(FieldTable, IsCompleteAndDocumented) {
  expect_complete_table<SceneDescription>();
  expect_complete_table<VolumeDescription>();
  expect_complete_table<TransferDescription>();
  expect_complete_table<TransferPoint>();
  expect_complete_table<LabelsDescription>();
  expect_complete_table<MaterialDescription>();
  expect_complete_table<LightDescription>();
  expect_complete_table<EnvironmentDescription>();
  expect_complete_table<BackgroundDescription>();
  expect_complete_table<CameraDescription>();
  expect_complete_table<ClipDescription>();
  expect_complete_table<ImageDescription>();
  expect_complete_table<RenderDescription>();
  expect_complete_table<AnimationDescription>();
  expect_complete_table<TurntableDescription>();
  expect_complete_table<AnimationTrack>();
}

TEST(SetSceneField, ReadsTextByTheTypeOfTheField) {
  SceneDescription s;
  const auto set = [&](const char* address, const char* text) { set_scene_field(s, address, text, "--x"); };
  set("/image/spp", "16");
  set("/image/exposure_ev", "-1.5");
  set("/image/aovs", "depth,normal");
  set("/image/tone_curve", "srgb");
  set("/render/seed", "18446744073709551615");
  set("/volume/path", "12");
  set("/volume/spacing_mm", "1,2,3.5");
  set("/material/opacity_modulated", "false");
  set("/environment/image", "sky.exr");
  set("/background/color", "1,0,1");
  set("/clip/x_mm/1", "7");
  set("/transfer/points", R"([{"value": 1, "opacity": 0.5}])");
  set("/transfer/points/0/opacity", "0.25");
  set("/camera/up", "0,0,-1");
  EXPECT_EQ(s.image.spp, 16);
  EXPECT_EQ(s.image.exposure_ev, -1.5);
  EXPECT_EQ(s.image.aovs, (std::vector<std::string>{"depth", "normal"}));
  EXPECT_EQ(s.image.tone_curve, ToneCurve::kSrgb);
  EXPECT_EQ(s.render.seed, 18446744073709551615ull);
  EXPECT_EQ(s.volume.path, "12");
  EXPECT_EQ(s.volume.spacing_mm, (Double3{1, 2, 3.5}));
  EXPECT_FALSE(s.material.opacity_modulated);
  EXPECT_EQ(s.environment->image, "sky.exr");
  EXPECT_EQ(s.background->color.linear, (std::array<float, 3>{1, 0, 1}));
  EXPECT_EQ(s.clip->x_mm[1], 7);
  EXPECT_EQ(s.transfer.points[0].opacity, 0.25);
  EXPECT_EQ(s.camera.up, (Double3{0, 0, -1}));
}

TEST(SetSceneField, RefusesWithTheCallersName) {
  const auto refused = [](const char* address, const char* text, const char* message) {
    SceneDescription s;
    try {
      set_scene_field(s, address, text, "--flag");
      ADD_FAILURE() << address << " took " << text;
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr(message));
      EXPECT_THAT(e.what(), testing::StartsWith("--flag"));
    }
  };
  refused("/image/spp", "0", "found 0, expected a whole number in [1, ");
  refused("/image/spp", "many", "found \"many\", expected a whole number");
  refused("/image/spp", "", "found \"\", expected a whole number");
  refused("/image/spp", "1 ", "found \"1 \"");
  refused("/image/spp", "99999999999999999999999", "found 1e+23");
  refused("/image/seconds", "nan", "found nan, expected a number in (0, ");
  refused("/image/exposure_ev", "inf", "found inf");
  refused("/image/aovs", "depth,,normal", "--flag/1: found \"\", expected one of alpha");
  refused("/camera/up", "1,2", "found a list of 2, expected a list of 3 numbers");
  refused("/material/opacity_modulated", "yes", "found \"yes\", expected true or false");
  refused("/background/color", "1,2,0", "found 2, expected a color");
  refused("/transfer/points", "[{]", "expected JSON");
  refused("/transfer/points/0/opacity", "1", "found element \"0\", expected one of the list's 0");
  refused("/image/ssp", "1", "unknown field \"ssp\"; did you mean \"spp\"?");
  refused("/image/spp/0", "1", "unknown field \"0\"; a plain value has no fields");
  refused("image", "1", "expected an address");
  refused("/render/denoise", "blur", "expected one of none, decoupled, svgf");
}

TEST(ValidateScene, ChecksDescriptionsMadeByPrograms) {
  EXPECT_NO_THROW(validate_scene(SceneDescription{}));
  EXPECT_NO_THROW(validate_scene(full_scene()));
  SceneDescription s;
  s.camera.zoom = std::numeric_limits<double>::quiet_NaN();
  try {
    validate_scene(s);
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "/camera/zoom: found nan, expected a number in [1e-06, 1000000]");
    EXPECT_EQ(e.code(), ErrorCode::kBadParameter);
  }
}

TEST(NearestWord, SuggestsSlipsOfTheFingerOnly) {
  const std::vector<std::string_view> words{"opacity", "mu_t_per_mm", "color"};
  EXPECT_EQ(nearest_word("opacty", words), "opacity");
  EXPECT_EQ(nearest_word("colour", words), "color");
  EXPECT_EQ(nearest_word("zzz", words), "");
  EXPECT_EQ(nearest_word("", words), "");
}

}  // namespace
}  // namespace voxlume
