#include "render/statistics.h"

#include <sys/resource.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"

namespace voxlume {
namespace {

std::uint64_t max_rss_bytes(int who) {
  rusage usage{};
  if (getrusage(who, &usage) != 0) return 0;
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts in KiB
}

}  // namespace

RenderStatistics statistics_from(const RenderState& state) {
  RenderStatistics s;
  s.wall_s = state.elapsed_s;
  s.width = state.film.width();
  s.height = state.film.height();
  s.spp = static_cast<double>(state.film.total_samples()) / static_cast<double>(state.film.pixel_count());
  s.paths = state.counters.paths;
  s.tracking_steps = state.counters.tracking_steps;
  s.shadow_rays = state.counters.shadow_rays;
  s.scatterings = state.counters.scatterings;
  s.majorant_violations = state.counters.majorant_violations;
  s.peak_rss_bytes = peak_rss_bytes();
  s.nonfinite_samples = state.film.nonfinite_samples();
  s.mean_luminance = state.film.mean_luminance();
  s.noise = state.film.noise();
  return s;
}

nlohmann::json to_json(const RenderStatistics& s) {
  const auto rate = [&](std::uint64_t count) {
    return s.wall_s > 0 ? static_cast<double>(count) / s.wall_s : 0.0;
  };
  return {
      {"wall_s", s.wall_s},
      {"load_s", s.load_s},
      {"total_s", s.total_s},
      {"threads", s.threads},
      {"simd", s.simd},
      {"integrator", s.integrator},
      {"width", s.width},
      {"height", s.height},
      {"spp", s.spp},
      {"paths", s.paths},
      {"tracking_steps", s.tracking_steps},
      {"shadow_rays", s.shadow_rays},
      {"scatterings", s.scatterings},
      {"majorant_violations", s.majorant_violations},
      {"steps_per_s", rate(s.tracking_steps)},
      {"paths_per_s", rate(s.paths)},
      {"majorant_build_ms", s.majorant_build_ms},
      {"importance_list_s", s.importance_list_s},
      {"importance_list_mb", static_cast<double>(s.importance_list_bytes) * 1e-6},
      {"peak_rss_bytes", s.peak_rss_bytes},
      {"nonfinite_samples", s.nonfinite_samples},
      {"mean_luminance", s.mean_luminance},
      {"noise", s.noise},
      {"seed", s.seed},
      {"version", s.version},
  };
}

std::uint64_t peak_rss_bytes() {
  return std::max(max_rss_bytes(RUSAGE_SELF), max_rss_bytes(RUSAGE_CHILDREN));
}

void write_statistics(const RenderStatistics& statistics, const std::filesystem::path& path) {
  write_file_atomically(path, to_json(statistics).dump(2) + "\n");
}

}  // namespace voxlume
