#pragma once
#include "light/direction_bins.h"
#include "light/environment.h"

namespace voxlume {

/// The probabilities of the cell that holds p_world.
inline Distribution1DView guide_cell(const EnvironmentGuideView& guide, Vec3f p_world) noexcept {
  std::int64_t at = 0, stride = 1;
  for (int a = 0; a < 3; ++a) {
    const float share = (p_world[a] - guide.box.lower[a]) / (guide.box.upper[a] - guide.box.lower[a]);
    const int cell = static_cast<int>(std::clamp(share, 0.0f, 1.0f) * static_cast<float>(guide.count[a]));
    at += stride * std::min(cell, guide.count[a] - 1);
    stride *= guide.count[a];
  }
  return {guide.cdf + at * (DirectionBins::kCount + 1), DirectionBins::kCount};
}

/// eval_environment, the density being that of sample_environment_guided from p_world.
inline EnvironmentSample eval_environment_guided(const EnvironmentView& e, const EnvironmentGuideView& guide,
                                                 Vec3f p_world, Vec3f direction) noexcept {
  EnvironmentSample out = eval_environment(e, direction);
  const float probability = bin_probability(guide_cell(guide, p_world), DirectionBins::bin_of(direction));
  out.pdf = 0.5f * (out.pdf + probability * DirectionBins::kPdf);
  return out;
}

/// Draws a direction for a point.
inline EnvironmentSample sample_environment_guided(const EnvironmentView& e,
                                                   const EnvironmentGuideView& guide, Vec3f p_world, float u0,
                                                   float u1) noexcept {
  if (u0 >= 0.5f)
    return eval_environment_guided(e, guide, p_world, sample_environment(e, 2.0f * u0 - 1.0f, u1).wi);
  const BinSample bin = sample_bin(guide_cell(guide, p_world), 2.0f * u0);
  return eval_environment_guided(e, guide, p_world, DirectionBins::direction_in(bin.index, bin.offset, u1));
}

}  // namespace voxlume
