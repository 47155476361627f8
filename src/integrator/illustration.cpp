#include "integrator/illustration.h"

#include <algorithm>

namespace voxlume {

Vec3f illustrated(const IllustrationView& illustration, const MatterPoint& matter, Vec3f wo) noexcept {
  const ScatterPoint& point = matter.scatter;
  // The dummy extinction of the ramp is 1 everywhere, so that it has colours everywhere.
  const auto ramp = [&](float cosine) { return classify(illustration.ramp, cosine).albedo; };
  const float share = point.p_brdf;
  Vec3f color = ramp(0.0f) * (1.0f - share);
  float edge = 0;
  if (share > 0) {
    color += ramp(dot(point.normal, illustration.to_light)) * share;
    const float facing = std::abs(dot(point.normal, wo));
    edge = std::clamp(1.0f - facing / std::max(illustration.contour_width, 1e-6f), 0.0f, 1.0f) * share;
  }
  const float contour = illustration.contour * std::min(2.0f * edge, 1.0f);
  return point.albedo * color * (1.0f - contour) + illustration.contour_color * contour;
}

}  // namespace voxlume
