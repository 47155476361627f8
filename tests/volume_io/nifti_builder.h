#pragma once
#include <array>
#include <cstdint>
#include <cstring>
#include <string>

namespace voxlume::test {

/// A NIfTI-1 header written field by field from nifti1.h, independent of the library under test.
struct NiftiBuilder {
  std::array<std::int16_t, 8> dim{3, 2, 2, 2, 1, 1, 1, 1};
  std::int16_t datatype = 4;
  std::int16_t bits = 16;
  std::array<float, 8> pixdim{1, 1, 1, 1, 1, 1, 1, 1};
  float vox_offset = 352;
  float slope = 0;
  float intercept = 0;
  char units = 2;
  std::int16_t qform_code = 0;
  std::int16_t sform_code = 0;
  std::array<float, 6> quaternion{};
  std::array<float, 12> srow{};
  std::string magic = std::string("n+1\0", 4);
  std::int32_t header_size = 348;

  std::string header() const {
    std::string bytes(352, '\0');
    const auto put = [&](std::size_t at, const void* from, std::size_t count) {
      std::memcpy(&bytes[at], from, count);
    };
    put(0, &header_size, 4);
    put(40, dim.data(), 16);
    put(70, &datatype, 2);
    put(72, &bits, 2);
    put(76, pixdim.data(), 32);
    put(108, &vox_offset, 4);
    put(112, &slope, 4);
    put(116, &intercept, 4);
    bytes[123] = units;
    put(252, &qform_code, 2);
    put(254, &sform_code, 2);
    put(256, quaternion.data(), 24);
    put(280, srow.data(), 48);
    put(344, magic.data(), 4);
    return bytes;
  }
};

}  // namespace voxlume::test
