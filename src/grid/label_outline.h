#pragma once
#include <vector>

#include "grid/sample.h"

namespace voxlume {

/// Labels without stairs. Around every voxel labels are smoothed by the kernel of label_normal; its lead is
/// how far its own label is ahead there. At a point the eight voxels around vote for their own labels, by
/// their leads and trilinear weights: where two labels meet, the border is the surface on which the smoothed
/// fields are equal. Where more than two meet, the least label (the background, as a rule) is held against
/// all others together, then the next, so that a surface has no grooves where labels meet below it. Labels
/// thinner than the kernel are given a lead: every voxel's centre has the voxel's own label, and thin parts
/// keep about their thickness.

/// Leads of the voxels, in their order: 0 where the 26 neighbours have the voxel's label too, else 1 to 255.
/// One byte a voxel; takes about a second for 256^3 voxels of an atlas. NaN counts as a label.
std::vector<std::uint8_t> label_leads(const GridView& labels);

/// The label of a point by the vote of the eight voxels around: always that of one of them.
float voted_label(const GridView& labels, const std::uint8_t* leads, Vec3f p_index) noexcept;

/// voted_label, with one look where the nearest voxel is in the middle of its label.
inline float sample_outline(const GridView& labels, const std::uint8_t* leads, Vec3f p_index) noexcept {
  const std::int64_t at = nearest_voxel(labels, p_index);
  if (leads[at] != 0) return voted_label(labels, leads, p_index);
  return with_voxels(labels.type, labels.voxels, [&](const auto* v) { return static_cast<float>(v[at]); });
}

}  // namespace voxlume
