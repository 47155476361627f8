#pragma once
#include "tracking/tracking.h"
#include "voxlume/scene.h"

namespace voxlume {

// Scalar alternatives to delta and ratio tracking. All take the cells' minima as a control: an extinction
// whose part is known exactly, so that only what is above it is sampled. Without minima the control is 0.

/// Residual ratio tracking (Novak et al. 2014, "Residual ratio tracking for estimating attenuation in
/// participating media"): exp(-depth of the control) times ratio tracking of the rest, in [0, 1]; exact where
/// nothing varies within a cell, save for Russian roulette below kRouletteTransmittance.
float estimate_transmittance_residual(const Medium& medium, const TrackRay& ray, Rng& rng,
                                      TrackingCounters& counters) noexcept;

/// Unbiased ray marching (Kettunen et al. 2021, "An unbiased ray-marching transmittance estimator"), over
/// runs of bounded majorant depth, at points equidistant in that depth. Little variance; may fall below 0 or
/// above 1, rarely and by little.
float estimate_transmittance_marching(const Medium& medium, const TrackRay& ray, Rng& rng,
                                      TrackingCounters& counters) noexcept;

/// Decomposition tracking (Kutz et al. 2017, "Spectral and decomposition tracking for rendering heterogeneous
/// volumes"): the nearer one of a collision with the control, sampled in closed form, and one with the rest,
/// by delta tracking.
Collision sample_free_flight_decomposed(const Medium& medium, const TrackRay& ray, Rng& rng,
                                        TrackingCounters& counters) noexcept;

// Exposure Render's ray marching (Kroes et al. 2012), which is biased: steps of step_mm > 0 from a random
// offset in the first, until the sum of mu_t * step_mm passes a depth that is drawn. What is thinner than a
// step is met by chance. mu_t is the medium's own, where Exposure Render squares its density scale.

/// A flight that ends at the step where the depth is passed.
Collision sample_free_flight_stepped(const Medium& medium, const TrackRay& ray, float step_mm, Rng& rng,
                                     TrackingCounters& counters) noexcept;

/// Whether nothing stops a flight: 0 or 1.
float estimate_transmittance_stepped(const Medium& medium, const TrackRay& ray, float step_mm, Rng& rng,
                                     TrackingCounters& counters) noexcept;

/// Which of them a scene asks for.
struct TrackerChoice {
  TransmittanceEstimator transmittance = TransmittanceEstimator::kRatio;
  FreeFlightSampling free_flight = FreeFlightSampling::kDelta;
  float step_mm = 0;  ///< > 0: steps take the place of both

  /// Whether it is the pair that vector code tracks.
  bool is_default() const noexcept {
    return transmittance == TransmittanceEstimator::kRatio && free_flight == FreeFlightSampling::kDelta &&
           !(step_mm > 0);
  }
};

/// The chosen estimate of the transmittance.
inline float estimate_transmittance(const TrackerChoice& choice, const Medium& medium, const TrackRay& ray,
                                    Rng& rng, TrackingCounters& counters) noexcept {
  if (choice.step_mm > 0) return estimate_transmittance_stepped(medium, ray, choice.step_mm, rng, counters);
  switch (choice.transmittance) {
    case TransmittanceEstimator::kResidual:
      return estimate_transmittance_residual(medium, ray, rng, counters);
    case TransmittanceEstimator::kMarching:
      return estimate_transmittance_marching(medium, ray, rng, counters);
    case TransmittanceEstimator::kRatio:
      break;
  }
  return estimate_transmittance(medium, ray, rng, counters);
}

/// The chosen free flight.
inline Collision sample_free_flight(const TrackerChoice& choice, const Medium& medium, const TrackRay& ray,
                                    Rng& rng, TrackingCounters& counters) noexcept {
  if (choice.step_mm > 0) return sample_free_flight_stepped(medium, ray, choice.step_mm, rng, counters);
  return choice.free_flight == FreeFlightSampling::kDecomposition
             ? sample_free_flight_decomposed(medium, ray, rng, counters)
             : sample_free_flight(medium, ray, rng, counters);
}

}  // namespace voxlume
