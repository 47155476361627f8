#pragma once
#include "tracking/tracking.h"

namespace voxlume {

// Tracking where every channel c has an extinction of its own, mu_c = mu_t times the extinction colour's
// channel, at most mu_t. Tentative collisions come at the rate of mu_t's majorant for all channels, so that
// the transmittances of the majorant cancel and only ratios of probabilities are carried.

/// A free flight that serves all channels.
struct RgbFlight {
  Collision collision;
  /// What the flight multiplies the throughput by. The sum of the throughput's channels stays what it was.
  Vec3f weight;
};

/// History-aware spectral tracking (Kutz et al. 2017, "Spectral and decomposition tracking for rendering
/// heterogeneous volumes"): a tentative collision is real with the mean of the channels' probabilities
/// mu_c / mu_maj, each in proportion to what its channel carries at that point; the weight of a channel is
/// multiplied by its own probability of what happened over that mean. Weights can thus be of any ratio, but
/// no channel ever carries more than all did at first; a channel without extinction goes through, and the
/// others collide. `throughput` is what the path carries, not negative, not 0.
RgbFlight sample_rgb_flight(const Medium& medium, const TrackRay& ray, Vec3f throughput, Rng& rng,
                            TrackingCounters& counters) noexcept;

/// Ratio tracking of all channels at the same tentative collisions: an unbiased estimate of each one's
/// transmittance, not negative. Russian roulette ends it where the greatest falls below
/// kRouletteTransmittance, or raises that one back to it.
Vec3f estimate_rgb_transmittance(const Medium& medium, const TrackRay& ray, Rng& rng,
                                 TrackingCounters& counters) noexcept;

}  // namespace voxlume
