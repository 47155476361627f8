#pragma once
#include "denoise/temporal.h"

namespace voxlume {

/// What TemporalHistory::blend reads.
struct TemporalInput {
  const DenoiseFrame& frame;
  const Guides &guides, &guides_before;
  const Reprojection* moved;  ///< null: there is no history
  const TemporalMeans& before;
  const Signal& colors;
  const Plane* change;
};

/// Row y of TemporalHistory::blend, with the variance over time.
void blend_row(const TemporalInput& input, int y, TemporalMeans& now, Plane& alpha_counts, Signal& out);

/// Replaces the variance of row y by that over 7 x 7 pixels where a history is short.
void spatial_variance_row(const TemporalMeans& now, const Guides& guides, int y, Plane& variance);

}  // namespace voxlume
