#pragma once
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace voxlume {

// What is known of the importance k(t) along a ray, a step function: runs of one importance, and the integral
// of k^2 (lerzer2025 section 5). Distances are mm along the ray.

/// A run of one importance; of length 0 where only one point is known.
struct ImportanceSegment {
  float t, length;
  float k;         ///< [0, 1]
  float integral;  ///< of k^2 from the ray's entry to t [mm]
  float end() const noexcept { return t + length; }
};

/// The segments of a ray, in order and apart.
struct SegmentListView {
  const ImportanceSegment* segments = nullptr;
  std::int32_t count = 0;
  float entry = 0, exit = 0;  ///< of the ray's visible part
  float total = 0;            ///< integral of k^2 over it
};

/// The integral of k^2 from the entry to t; between segments it rises evenly.
float importance_before(const SegmentListView& list, float t) noexcept;

/// A point of the ray whose importance was looked up.
struct ImportanceSample {
  float t, k;
};

/// Merges samples, in order, into segments (lerzer2025 Alg. 1, what is inside a segment tested before what is
/// near it, as else nothing is ever found inside): neighbours of one importance that are less than `join`
/// apart become one segment; a sample of another importance inside a segment leaves its ends as points. `out`
/// is overwritten; it takes at most twice the old segments and the samples.
void merge_samples(std::span<const ImportanceSegment> old, std::span<const ImportanceSample> samples,
                   float join, std::vector<ImportanceSegment>& out);

/// Fills in the integrals of [entry, exit] and returns the total. Where nothing is known k is the mean of its
/// neighbours', which are 0 at both ends of the ray.
float integrate_segments(std::span<ImportanceSegment> segments, float entry, float exit) noexcept;

/// Part of a ray that gets samples, one a stratum.
struct StrataRun {
  float begin, end;
  std::int32_t count;
};

/// Where `count` strata find out most: in gaps, most of all in those between different importances, at both
/// ends of the ray, least within segments (lerzer2025 section 5.2). Weights by length, 4 2 2 1; at least one
/// stratum in every gap between different importances while there are enough. `out` is overwritten.
void adaptive_strata(std::span<const ImportanceSegment> segments, float entry, float exit, int count,
                     std::vector<StrataRun>& out);

}  // namespace voxlume
