#include "volume_io/reorient.h"

#include <cmath>
#include <vector>

#include "base/fail.h"

namespace voxlume {
namespace {

/// Which LPS axis each index axis runs along, and which way.
struct AxisMap {
  std::array<std::size_t, 3> world;
  std::array<bool, 3> reversed;
  bool identity = true;
};

AxisMap find_axes(const std::filesystem::path& path, const Volume& volume) {
  AxisMap map{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    bool found = false;
    for (std::size_t w = 0; w < 3; ++w) {
      const double cosine = volume.direction[3 * w + axis];
      if (std::abs(std::abs(cosine) - 1) > 1e-4) continue;
      map.world[axis] = w;
      map.reversed[axis] = cosine < 0;
      map.identity = map.identity && w == axis && cosine > 0;
      found = true;
    }
    if (!found) {
      fail(ErrorCode::kUnsupported, path,
           "this format carries no orientation and the volume is oblique; write .nrrd, .nii or .mha instead");
    }
  }
  return map;
}

/// Copies every voxel to its new place. `step`: distance in voxels, in `out`, of one step along each axis of
/// `in`.
template <class T>
void reorder(const T* in, T* out, const Volume& volume, std::int64_t first,
             const std::array<std::int64_t, 3>& step) {
  for (std::int64_t k = 0; k < volume.size[2]; ++k) {
    for (std::int64_t j = 0; j < volume.size[1]; ++j) {
      std::int64_t at = first + k * step[2] + j * step[1];
      for (std::int64_t i = 0; i < volume.size[0]; ++i, at += step[0]) out[at] = *in++;
    }
  }
}

}  // namespace

Volume along_lps_axes(const std::filesystem::path& path, const Volume& volume) {
  const AxisMap map = find_axes(path, volume);
  if (map.identity) return volume;
  Volume out = volume;
  out.direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t w = map.world[axis];
    out.size[w] = volume.size[axis];
    out.spacing_mm[w] = volume.spacing_mm[axis];
    if (map.reversed[axis])
      out.origin_mm[w] -= static_cast<double>(volume.size[axis] - 1) * volume.spacing_mm[axis];
  }
  const std::array<std::int64_t, 3> stride{1, out.size[0], out.size[0] * out.size[1]};
  std::array<std::int64_t, 3> step{};
  std::int64_t first = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    step[axis] = stride[map.world[axis]] * (map.reversed[axis] ? -1 : 1);
    if (map.reversed[axis]) first += stride[map.world[axis]] * (volume.size[axis] - 1);
  }
  const auto voxels = std::make_shared<std::vector<unsigned char>>(volume.byte_count());
  const auto copy = [&]<class T>(T) {
    reorder(static_cast<const T*>(volume.voxels.get()), reinterpret_cast<T*>(voxels->data()), volume, first,
            step);
  };
  switch (voxel_bytes(volume.type)) {
    case 1:
      copy(std::uint8_t{});
      break;
    case 2:
      copy(std::uint16_t{});
      break;
    case 4:
      copy(std::uint32_t{});
      break;
    default:
      copy(std::uint64_t{});
      break;
  }
  out.voxels = std::shared_ptr<const void>(voxels, voxels->data());
  return out;
}

}  // namespace voxlume
