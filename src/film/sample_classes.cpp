#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/assert.h"
#include "film/film.h"

namespace voxlume {
namespace {

/// A sample that scattered, where its classes are decided.
struct Candidate {
  float luminance;  ///< of fx
  float depth_mm;
  std::size_t index;  ///< of the sample
};

bool usable(const PixelSample& sample, const RadianceParts& parts) noexcept {
  return sample.alpha > 0 && is_finite(sample.radiance) && std::isfinite(sample.depth_mm) &&
         is_finite(parts.fx_diffuse) && is_finite(parts.fx_specular) && is_finite(parts.direct_diffuse) &&
         is_finite(parts.direct_specular) && is_finite(parts.later);
}

/// Of the diffuse part: a peak of the specular one alone makes no class.
float class_luminance(const RadianceParts& parts) noexcept { return luminance(parts.fx_diffuse); }
float class_luminance(const ClassSums& sums) noexcept {
  return luminance(sums.fx_diffuse) / static_cast<float>(sums.count);
}

static_assert(sizeof(PixelClasses) == 176, "checkpoints hold it as bytes: no padding");

/// How many of the candidates, in ascending order of luminance, the first class takes.
std::size_t first_class_size(std::span<const Candidate> sorted) noexcept {
  if (sorted.back().luminance - sorted.front().luminance < Film::kOneClass) return sorted.size();
  std::size_t cut = 1;
  float largest = -1;
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    const float gap = sorted[i].luminance - sorted[i - 1].luminance;
    if (gap > largest) largest = gap, cut = i;
  }
  return cut;
}

/// The class whose mean is nearer; the second begins with the first sample that differs enough.
int nearest_class(const PixelClasses& pixel, float luminance) noexcept {
  const float first = std::abs(luminance - class_luminance(pixel.classes[0]));
  if (pixel.classes[1].count == 0) return first < Film::kOneClass ? 0 : 1;
  return std::abs(luminance - class_luminance(pixel.classes[1])) < first ? 1 : 0;
}

void add_to(ClassSums& sums, const RadianceParts& parts) noexcept {
  ++sums.count;
  sums.fx_diffuse += parts.fx_diffuse;
  sums.fx_specular += parts.fx_specular;
  sums.direct_diffuse += parts.direct_diffuse;
  sums.direct_specular += parts.direct_specular;
  sums.later += parts.later;
}

float median_depth(std::vector<Candidate>& candidates) {
  const auto middle = candidates.begin() + static_cast<std::ptrdiff_t>(candidates.size() / 2);
  std::nth_element(candidates.begin(), middle, candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.depth_mm < b.depth_mm; });
  return middle->depth_mm;
}

}  // namespace

void Film::add_classes(int x, int y, std::span<const PixelSample> samples,
                       std::span<const RadianceParts> parts) {
  VOXLUME_ASSERT(layers_.classes && samples.size() == parts.size());
  PixelClasses& pixel = classes_[index(x, y)];
  thread_local std::vector<Candidate> candidates;
  candidates.clear();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!usable(samples[i], parts[i])) continue;
    candidates.push_back({class_luminance(parts[i]), samples[i].depth_mm, i});
    const Vec3f radiance = samples[i].radiance - parts[i].behind;
    const double y_luminance = luminance(Vec3d(radiance));
    pixel.radiance += Vec3d(radiance);
    pixel.luminance_squared += y_luminance * y_luminance;
    const bool nearer = pixel.dense_depth_mm == 0 || samples[i].depth_mm < pixel.dense_depth_mm;
    if (parts[i].dense && nearer) pixel.dense_depth_mm = samples[i].depth_mm;
  }
  if (candidates.empty()) return;
  if (pixel.classes[0].count > 0) {
    for (const Candidate& c : candidates)
      add_to(pixel.classes[nearest_class(pixel, c.luminance)], parts[c.index]);
    return;
  }
  // By index where luminances are equal: the sums do not depend on how the library sorts.
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return a.luminance != b.luminance ? a.luminance < b.luminance : a.index < b.index;
  });
  const std::size_t cut = first_class_size(candidates);
  for (std::size_t i = 0; i < candidates.size(); ++i)
    add_to(pixel.classes[i < cut ? 0 : 1], parts[candidates[i].index]);
  pixel.median_depth_mm = median_depth(candidates);
}

}  // namespace voxlume
