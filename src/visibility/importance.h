#pragma once
#include <cmath>
#include <cstdint>

#include "transfer/classifier_view.h"
#include "visibility/segment_list.h"
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

/// Which cells of the main volume have one importance everywhere. Cell (i,j,k) has the points whose p_index,
/// truncated, is (i,j,k) << shift or up to a cell's side more; the last cells reach to the end of the volume.
struct ImportanceCellsView {
  static constexpr std::uint8_t kMixed = 255;

  const std::uint8_t* levels = nullptr;  ///< by cell, row by row; kMixed: not one; null: nothing is known
  const float* importance = nullptr;     ///< by level
  std::int32_t last[3] = {0, 0, 0};      ///< the greatest numbers of cells
  std::int32_t stride_j = 0, stride_k = 0, shift = 0;
  Box3f domain;     ///< the volume [p_index]
  Box3f important;  ///< the cells that are not all of importance 0 [p_index]

  /// The level of the cell that a point of the volume is in.
  std::uint8_t level_at(Vec3f p_index) const noexcept {
    const std::int32_t i = std::min(static_cast<std::int32_t>(p_index.x) >> shift, last[0]);
    const std::int32_t j = std::min(static_cast<std::int32_t>(p_index.y) >> shift, last[1]);
    const std::int32_t k = std::min(static_cast<std::int32_t>(p_index.z) >> shift, last[2]);
    return levels[i + std::int64_t{j} * stride_j + std::int64_t{k} * stride_k];
  }
};

/// What stored importances are multiplied by: those of rules are exact to 1.5e-5, and 0, 1/2 and 1 are exact.
inline constexpr float kImportanceStep = 1.0f / (1 << 15);

/// Importance of points: after interpolation of the volumes (lerzer2025 section 4.2), or interpolated between
/// voxels, where it is known (section 6.6).
struct ImportanceView {
  const ImportanceRule* rules = nullptr;
  std::int32_t rule_count = 0;
  RuleVolumeView volumes[kMostVolumes];
  ImportanceLookup lookup = ImportanceLookup::kInterpolated;
  GridView voxels;  ///< of the main volume, in kImportanceStep; only if voxels are looked up
  ImportanceCellsView cells;
};

/// importance_at, without the cells.
float look_up_importance(const ImportanceView& view, Vec3f p_index) noexcept;

/// The greatest importance of the rules that hold at a point, in [0, 1]; 0 where none does. Of voxels, what
/// is stored there, interpolated.
inline float importance_at(const ImportanceView& view, Vec3f p_index) noexcept {
  const ImportanceCellsView& cells = view.cells;
  if (cells.levels && cells.domain.contains(p_index)) {
    const std::uint8_t level = cells.level_at(p_index);
    if (level != ImportanceCellsView::kMixed) return cells.importance[level];
  }
  return look_up_importance(view, p_index);
}

/// How visibility is traded (lerzer2025 eq. 8), lengths in mm.
struct VisibilityWeights {
  float p = 1, q_per_mm = 0, r_per_mm = 0, lambda = 1;
};

/// (1 - g)^(2 lambda): how much of h a point of importance g is open to.
inline float openness(float lambda, float g) noexcept {
  const float rest = 1.0f - g;
  if (rest == 1 || lambda == 0) return 1;
  return lambda == 1 ? rest * rest : std::pow(rest, 2.0f * lambda);
}

/// mu' / mu at a point of importance g with integrals of the importance's square before it and beyond: in
/// (0, 1], and 1 where both are 0. h is what is before, weighted by r, and beyond, by q (eq. 7).
inline float visibility_factor(const VisibilityWeights& w, float before, float beyond, float g) noexcept {
  const float open = openness(w.lambda, g);
  if (!(open > 0)) return 1;
  const float h = w.r_per_mm * before + w.q_per_mm * beyond;
  return w.p / (w.p + open * h);
}

/// The same t mm along the ray of the list.
inline float visibility_factor(const VisibilityWeights& w, const SegmentListView& list, float t,
                               float g) noexcept {
  if (!(openness(w.lambda, g) > 0)) return 1;  // without a look at the list
  const float before = importance_before(list, t);
  return visibility_factor(w, before, std::max(list.total - before, 0.0f), g);
}

}  // namespace voxlume
