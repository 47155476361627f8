#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace voxlume {

/// When a picture is done. Of the rules given, the first reached ends it; at least one must be given.
struct StopRule {
  std::optional<int> spp;         ///< samples per pixel, >= 1
  std::optional<double> seconds;  ///< time since the first sample, over all resumed parts, > 0
  /// Mean over pixels of standard error / (luminance + 0.01), > 0. Looked at when all pixels have the same
  /// number of samples, which is 8, 16, 32 or a further multiple of 32: the picture does not depend on the
  /// machine's speed.
  std::optional<double> noise;
};

enum class RenderStatus {
  kDone,       ///< a stop rule was reached
  kCancelled,  ///< the caller asked to stop; what was rendered so far is valid
};

/// Where a render is.
struct RenderProgress {
  double spp = 0;                     ///< samples so far / pixels
  double elapsed_s = 0;               ///< since the first sample, over all resumed parts
  std::optional<double> remaining_s;  ///< estimate; absent while there is nothing to estimate from
  double samples_per_s = 0;           ///< camera samples
  std::optional<double> noise;        ///< as in StopRule, when last looked at
};

/// What `--stats` reports.
struct RenderStatistics {
  double wall_s = 0;   ///< first to last sample
  double load_s = 0;   ///< reading and compiling, before the first sample
  double total_s = 0;  ///< start of the program to this report
  int threads = 0;
  std::string simd;         ///< instruction set that traced: "scalar", ...
  std::string integrator;   ///< as in the scene file: "path", ...
  double spp = 0;           ///< mean over pixels
  std::uint64_t paths = 0;  ///< camera samples, misses included
  std::uint64_t tracking_steps = 0;
  std::uint64_t shadow_rays = 0;
  std::uint64_t scatterings = 0;
  std::uint64_t majorant_violations = 0;
  double majorant_build_ms = 0;
  double importance_list_s = 0;  ///< building the lists of what is important; 0: kept, or nothing is
  std::uint64_t importance_list_bytes = 0;
  std::uint64_t peak_rss_bytes = 0;
  std::uint64_t nonfinite_samples = 0;
  double mean_luminance = 0;  ///< linear, whole image
  double noise = 0;           ///< as in StopRule
  int width = 0, height = 0;
  std::uint64_t seed = 0;
  std::string version;
};

}  // namespace voxlume
