#include "grid/phantom.h"

#include <cmath>

#include "base/parallel.h"
#include "base/vec.h"

namespace voxlume {
namespace {

constexpr int kSize = 192;
constexpr double kSpacing_mm = 1.2;

/// Replaces the matter inside an ellipsoid; the border is blurred over about one voxel, as a scanner's is.
struct Ellipsoid {
  Vec3d center_mm, radius_mm;
  double hounsfield;

  double coverage(Vec3d p) const {
    const Vec3d q = (p - center_mm) / radius_mm;
    const double inside_mm = (1 - length(q)) * min_component(radius_mm);
    return std::min(1.0, std::max(0.0, 0.5 + inside_mm / kSpacing_mm));
  }
};

/// From the outside in; each lies over those before it. y is negative at the face.
const Ellipsoid kHead[] = {
    {{0, 5, 18}, {78, 96, 88}, 40},                                           // scalp
    {{0, -48, -40}, {50, 42, 50}, 40},                                        // face
    {{0, -98, -22}, {11, 15, 17}, 30},                                        // nose
    {{80, 10, -12}, {7, 14, 26}, 10},                                         // ears
    {{-80, 10, -12}, {7, 14, 26}, 10},   {{0, 30, -85}, {50, 50, 60}, 45},    // neck
    {{0, 6, 20}, {72, 90, 82}, 900},                                          // skull
    {{0, -46, -32}, {42, 36, 32}, 750},                                       // upper jaw and cheek bones
    {{0, -50, -72}, {38, 36, 14}, 950},                                       // lower jaw
    {{0, -40, -70}, {29, 36, 30}, 40},   {{0, 42, -90}, {14, 16, 55}, 600},   // spine
    {{0, 42, -90}, {7, 8, 60}, 20},      {{0, 7, 21}, {65, 83, 75}, 35},      // brain
    {{13, 2, 28}, {6, 28, 12}, 5},                                            // ventricles
    {{-13, 2, 28}, {6, 28, 12}, 5},      {{31, -76, -8}, {18, 26, 16}, -60},  // orbits
    {{-31, -76, -8}, {18, 26, 16}, -60}, {{31, -82, -8}, {12, 12, 12}, 20},   // eyes
    {{-31, -82, -8}, {12, 12, 12}, 20},  {{0, -72, -26}, {9, 26, 20}, -900},  // nasal cavity
    {{0, -58, -50}, {24, 26, 7}, -700},                                       // mouth
};

double tooth_row(Vec3d p, double height_mm) {
  const double radius = std::hypot(p.x / 0.9, p.y + 50);
  const double angle = std::atan2(p.x / 0.9, -(p.y + 50));
  if (std::abs(angle) > 1.5 || std::abs(radius - 30) > 4) return 0;
  const double gap = std::abs(std::sin(angle * 8));
  return gap > 0.25 && std::abs(p.z - height_mm) < 5 ? 1 : 0;
}

double hounsfield(Vec3d p) {
  double value = -1000;
  for (const Ellipsoid& part : kHead) value += (part.hounsfield - value) * part.coverage(p);
  if (tooth_row(p, -45) > 0 || tooth_row(p, -56) > 0) value = 2200;
  return value;
}

}  // namespace

Volume make_head_phantom() {
  auto voxels = std::make_shared<std::vector<std::int16_t>>(std::size_t{kSize} * kSize * kSize);
  const double first = -0.5 * (kSize - 1) * kSpacing_mm;
  parallel_for(kSize, 1, [&](std::int64_t k) {
    std::int16_t* v = voxels->data() + k * kSize * kSize;
    for (int j = 0; j < kSize; ++j)
      for (int i = 0; i < kSize; ++i)
        *v++ = static_cast<std::int16_t>(
            std::lround(hounsfield(Vec3d(i, j, static_cast<double>(k)) * kSpacing_mm + Vec3d(first))));
  });
  Volume volume;
  volume.size = {kSize, kSize, kSize};
  volume.type = VoxelType::kI16;
  volume.spacing_mm = {kSpacing_mm, kSpacing_mm, kSpacing_mm};
  volume.origin_mm = {first, first, first};
  volume.voxels = std::shared_ptr<const void>(voxels, voxels->data());
  volume.modality = "CT";
  volume.format = "phantom";
  return volume;
}

}  // namespace voxlume
