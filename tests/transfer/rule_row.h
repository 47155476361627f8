#pragma once
#include <gtest/gtest.h>

#include "support/rule_volumes.h"

namespace voxlume::test {

inline constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
inline constexpr double kLength_mm = 2, kScale = 3;

/// mu_t of an opacity by the convention of the scene file.
inline double extinction(double opacity, double length_mm = kLength_mm, double scale = kScale) {
  return -std::log1p(-std::min(opacity, 0.9999)) / length_mm * scale;
}

inline float below(double value) { return std::nextafter(static_cast<float>(value), -1e30f); }
inline float above(double value) { return std::nextafter(static_cast<float>(value), 1e30f); }

inline Color linear(float r, float g, float b) { return {{r, g, b}}; }

/// Rules over rows of voxels: the place of a point is the number of its voxel.
class Row {
 public:
  explicit Row(const std::vector<float>& data) : volumes_(row_volume(data)) {
    transfer.reference_length_mm = kLength_mm;
    transfer.density_scale = kScale;
  }
  Row& with(const std::string& name, const std::vector<float>& values, Lookup lookup = Lookup::kLinear) {
    volumes_.add(name, row_volume(values), lookup);
    return *this;
  }
  Row& rule(RuleDescription one) {
    transfer.rules.push_back(std::move(one));
    return *this;
  }

  Classified at(int voxel) const {
    const Classifier classifier(transfer, volumes_.all(), materials);
    const Vec3f p(static_cast<float>(voxel), 0, 0);
    const float data = sample_trilinear(volumes_.main(), p);
    const Classified out = classify(classifier.view(), p, data);
    EXPECT_EQ(classify_mu_t(classifier.view(), p, data), out.optics.mu_t) << "voxel " << voxel;
    return out;
  }
  /// Expects these opacities voxel by voxel, to `tolerance` of the extinction.
  void expect_opacities(const std::vector<double>& opacities, double tolerance = 1e-6) const {
    for (std::size_t i = 0; i < opacities.size(); ++i) {
      const double expected = extinction(opacities[i]);
      EXPECT_NEAR(at(static_cast<int>(i)).optics.mu_t, expected, tolerance * expected) << "voxel " << i;
    }
  }

  TransferDescription transfer;
  std::vector<NamedMaterialDescription> materials;

 private:
  RuleVolumeSet volumes_;
};

inline const std::vector<TransferPoint> kCurve{opacity_point(0, 0), opacity_point(100, 0.5),
                                               opacity_point(100, 0.2), opacity_point(200, 0.8)};

inline NamedMaterialDescription material(const std::string& name, double opacity, double roughness) {
  NamedMaterialDescription out;
  out.name = name;
  out.opacity = opacity;
  out.roughness = roughness;
  return out;
}

}  // namespace voxlume::test
