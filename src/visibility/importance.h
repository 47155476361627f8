#pragma once
#include <cmath>
#include <cstdint>

#include "visibility/segment_list.h"
#include "transfer/classifier_view.h"
#include "voxlume/scene.h"

namespace voxlume {

/// One description of what is important: values of up to two volumes, and a region; all that are given must
/// hold.
struct ImportanceRule {
  float importance;
  std::int32_t volume = -1, along = -1;  ///< of ImportanceView::volumes; -1: not asked
  float lower[2], upper[2];              ///< closed ranges of their values
  Box3f box;                             ///< LPS mm; empty: not asked
  Vec3f center;                          ///< of a sphere, LPS mm
  float radius2 = -1;                    ///< mm^2; negative: not asked
};

/// Importance of points, after interpolation of the volumes (lerzer2025 section 4.2).
struct ImportanceView {
  const ImportanceRule* rules = nullptr;
  std::int32_t rule_count = 0;
  RuleVolumeView volumes[kMostVolumes];
};

/// The greatest importance of the rules that hold at a point, in [0, 1]; 0 where none does.
float importance_at(const ImportanceView& view, Vec3f p_index) noexcept;

/// How visibility is traded (lerzer2025 eq. 8), lengths in mm.
struct VisibilityWeights {
  float p = 1, q_per_mm = 0, r_per_mm = 0, lambda = 1;
};

/// mu' / mu at a point of importance g, t mm along the ray of the list: in (0, 1], and 1 without anything
/// important on the ray. h is what is important before the point, weighted by r, and beyond, by q (eq. 7).
inline float visibility_factor(const VisibilityWeights& w, const SegmentListView& list, float t,
                               float g) noexcept {
  const float before = importance_before(list, t);
  const float h = std::max((w.r_per_mm - w.q_per_mm) * before + w.q_per_mm * list.total, 0.0f);
  const float open = std::pow(1.0f - g, 2.0f * w.lambda);
  return w.p / (w.p + open * h);
}

}  // namespace voxlume
