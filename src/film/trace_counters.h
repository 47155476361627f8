#pragma once
#include <cstdint>

namespace voxlume {

/// What tracing did, summed over tiles. Integers only, so that the sum does not depend on its order.
struct TraceCounters {
  std::uint64_t paths = 0;                ///< camera samples, misses included
  std::uint64_t tracking_steps = 0;       ///< tentative collisions, of camera paths and shadow rays
  std::uint64_t shadow_rays = 0;          ///< transmittance estimates toward lights
  std::uint64_t scatterings = 0;          ///< real collisions
  std::uint64_t majorant_violations = 0;  ///< steps where the extinction exceeded its majorant; must stay 0

  constexpr TraceCounters& operator+=(const TraceCounters& o) noexcept {
    paths += o.paths;
    tracking_steps += o.tracking_steps;
    shadow_rays += o.shadow_rays;
    scatterings += o.scatterings;
    majorant_violations += o.majorant_violations;
    return *this;
  }
  friend constexpr bool operator==(const TraceCounters&, const TraceCounters&) = default;
};

}  // namespace voxlume
