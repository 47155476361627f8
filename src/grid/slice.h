#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "voxlume/volume.h"

namespace voxlume {

/// A plane of a volume across an LPS axis, resampled. Columns grow toward +x (+y across x), rows toward +z
/// (+y across z).
struct Slice {
  int width = 0, height = 0;
  std::array<double, 2> origin_mm{0, 0};  ///< the first sample's place: along columns, along rows
  double spacing_mm = 1;                  ///< between samples, both ways
  double scale = 1, offset = 0;           ///< a sample u > 0 stands for offset + scale * (u - 1)
  std::vector<std::uint16_t> samples;     ///< row by row; 0: outside the volume, or not finite
};

struct SliceRequest {
  int axis = 2;                 ///< 0 x, 1 y, 2 z
  double place_mm = 0;          ///< of the plane along the axis
  bool nearest = false;         ///< labels; else interpolated
  double lower = 0, upper = 1;  ///< finite values of the volume, which the samples' range holds
  int most_samples = 1024;      ///< of the longer side; >= 1
};

/// Samples of the plane where the volume's bounding box crosses it, as far apart as the smallest voxel
/// spacing or as far as `most_samples` asks for. With `nearest`, samples of whole numbers in a range of at
/// most 65534 stand for them exactly.
Slice resample_slice(const Volume& volume, const SliceRequest& request);

}  // namespace voxlume
