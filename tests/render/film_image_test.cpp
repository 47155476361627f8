#include "render/film_image.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "render/statistics.h"
#include "render/synthetic_trace.h"
#include "support/temporary_folder.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

const std::vector<std::string> kAovs{"alpha", "depth", "normal", "albedo", "samples", "variance"};

TEST(FilmImage, EveryLayerOfTheTable) {
  const Film film = test::direct_state(6, 5, 9).film;
  const Image image = image_from_film(film, kAovs, false);
  ASSERT_EQ(image.layers.size(), 6u);
  const int x = 4, y = 3, i = y * 6 + x;
  EXPECT_EQ(image.pixel(x, y)[1], static_cast<float>(film.mean(x, y).y));
  EXPECT_EQ(image.pixel(x, y)[3], 1.0f);
  EXPECT_EQ(image.layer("alpha")->values[i], static_cast<float>(film.alpha(x, y)));
  EXPECT_EQ(image.layer("depth")->values[i], static_cast<float>(film.depth_mm(x, y)));
  EXPECT_EQ(image.layer("depth")->channels, std::vector<std::string>{"Z"});
  EXPECT_EQ(image.layer("normal")->values[3 * i + 2], static_cast<float>(film.normal(x, y).z));
  EXPECT_EQ(image.layer("normal")->channels, (std::vector<std::string>{"X", "Y", "Z"}));
  EXPECT_EQ(image.layer("albedo")->values[3 * i], static_cast<float>(film.albedo(x, y).x));
  EXPECT_EQ(image.layer("samples")->values[i], 9.0f);
  EXPECT_EQ(image.layer("variance")->values[i], static_cast<float>(film.variance_of_mean(x, y)));
}

TEST(FilmImage, AlphaIsCoverageWhenTransparent) {
  const Film film = test::direct_state(6, 5, 9).film;
  const Image image = image_from_film(film, {}, true);
  EXPECT_TRUE(image.layers.empty());
  EXPECT_EQ(image.pixel(2, 1)[3], static_cast<float>(film.alpha(2, 1)));
}

TEST(FilmImage, LayersFollowTheNames) {
  EXPECT_EQ(film_layers({}), FilmLayers{});
  EXPECT_EQ(film_layers({"alpha", "samples", "variance"}), FilmLayers{});
  EXPECT_EQ(film_layers({"depth", "albedo"}), (FilmLayers{.depth = true, .albedo = true}));
  EXPECT_EQ(film_layers(kAovs), test::kAllLayers);
}

TEST(FilmImage, RefusesUnknownAndMissing) {
  try {
    film_layers({"depht"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(error.message().find("depht"), std::string::npos);
    EXPECT_NE(error.message().find("alpha, depth, normal, albedo, samples, variance"), std::string::npos);
  }
  EXPECT_THROW(image_from_film(Film(2, 2), {"depth"}, false), Error);
}

TEST(Statistics, HoldsEveryKey) {
  RenderState state = test::direct_state(6, 5, 9);
  state.elapsed_s = 2;
  RenderStatistics statistics = statistics_from(state);
  statistics.load_s = 0.5;
  statistics.total_s = 3;
  statistics.threads = 4;
  statistics.simd = "scalar";
  statistics.seed = 18446744073709551615u;
  statistics.version = "0.1.0";
  const test::TemporaryFolder folder;
  write_statistics(statistics, folder / "stats.json");
  const auto json = nlohmann::json::parse(test::read_bytes(folder / "stats.json"));
  for (const char* key :
       {"wall_s", "load_s", "total_s", "threads", "simd", "spp", "paths", "tracking_steps", "steps_per_s",
        "paths_per_s", "majorant_build_ms", "importance_list_s", "importance_list_mb", "peak_rss_bytes",
        "nonfinite_samples", "mean_luminance", "seed", "version"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["wall_s"], 2.0);
  EXPECT_EQ(json["spp"], 9);
  EXPECT_EQ(json["paths"], 6 * 5 * 9);
  EXPECT_EQ(json["paths_per_s"], 6 * 5 * 9 / 2.0);
  EXPECT_EQ(json["tracking_steps"], state.counters.tracking_steps);
  EXPECT_EQ(json["seed"], 18446744073709551615u);
  EXPECT_EQ(json["mean_luminance"], state.film.mean_luminance());
}

TEST(Statistics, PeakMemorySeesAnAllocation) {
  const std::uint64_t before = peak_rss_bytes();
  EXPECT_GT(before, 1u << 20);
  const std::vector<char> ballast(before + (64u << 20), 1);
  EXPECT_GE(peak_rss_bytes(), before + (60u << 20));
  EXPECT_EQ(ballast.back(), 1);
}

}  // namespace
}  // namespace voxlume
