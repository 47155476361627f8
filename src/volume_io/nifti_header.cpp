#include "volume_io/nifti_header.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "base/fail.h"
#include "volume_io/geometry_check.h"
#include "volume_io/voxel_stream.h"

namespace voxlume {
namespace {

// Byte offsets are those of nifti1.h and nifti2.h.
constexpr std::size_t kBytes1 = 348;
constexpr std::size_t kBytes2 = 540;

/// Reads numbers at given offsets in the file's byte order.
class Fields {
 public:
  Fields(const std::vector<unsigned char>& bytes, bool swapped) : bytes_(bytes), swapped_(swapped) {}

  template <typename T>
  T at(std::size_t offset) const {
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof(T));
    if (swapped_) swap_bytes(&value, 1, sizeof(T));
    return value;
  }

  template <typename T, typename To, std::size_t kCount>
  void copy(std::size_t offset, std::array<To, kCount>& to) const {
    for (std::size_t i = 0; i < kCount; ++i) to[i] = static_cast<To>(at<T>(offset + i * sizeof(T)));
  }

 private:
  const std::vector<unsigned char>& bytes_;
  bool swapped_;
};

NiftiHeader parse_version_1(const Fields& fields) {
  NiftiHeader header;
  fields.copy<std::int16_t>(40, header.dim);
  header.datatype = fields.at<std::int16_t>(70);
  fields.copy<float>(76, header.pixdim);
  header.vox_offset = fields.at<float>(108);
  header.slope = fields.at<float>(112);
  header.intercept = fields.at<float>(116);
  header.units = fields.at<std::uint8_t>(123);
  header.qform_code = fields.at<std::int16_t>(252);
  header.sform_code = fields.at<std::int16_t>(254);
  fields.copy<float>(256, header.quaternion);
  fields.copy<float>(280, header.srow);
  return header;
}

NiftiHeader parse_version_2(const Fields& fields) {
  NiftiHeader header;
  header.datatype = fields.at<std::int16_t>(12);
  fields.copy<std::int64_t>(16, header.dim);
  fields.copy<double>(104, header.pixdim);
  header.vox_offset = static_cast<double>(fields.at<std::int64_t>(168));
  header.slope = fields.at<double>(176);
  header.intercept = fields.at<double>(184);
  header.qform_code = fields.at<std::int32_t>(344);
  header.sform_code = fields.at<std::int32_t>(348);
  fields.copy<double>(352, header.quaternion);
  fields.copy<double>(400, header.srow);
  header.units = fields.at<std::int32_t>(500);
  return header;
}

std::vector<unsigned char> read_start(const std::filesystem::path& path, bool deflated, std::size_t bytes) {
  std::vector<unsigned char> start(bytes);
  if (deflated) {
    read_deflated_start(path, start.data(), bytes);
  } else if (const std::uint64_t found = std::filesystem::file_size(path); found < bytes) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("expected a header of {} bytes, file has {}", bytes, found));
  } else {
    read_plain(path, 0, start.data(), bytes);
  }
  return start;
}

void check(const std::filesystem::path& path, const NiftiHeader& header, std::size_t header_bytes) {
  if (header.dim[0] < 1 || header.dim[0] > 7) {
    fail(ErrorCode::kBadFormat, path, fmt::format("{} dimensions; expected 1 to 7", header.dim[0]));
  }
  std::string size;
  bool flat = true;
  for (std::int64_t a = 1; a <= header.dim[0]; ++a) {
    const std::int64_t n = header.dim[static_cast<std::size_t>(a)];
    if (n < 1) fail(ErrorCode::kBadFormat, path, fmt::format("dim[{}] is {}; expected 1 or more", a, n));
    size += fmt::format("{}{}", a > 1 ? "x" : "", n);
    flat = flat && (a <= 3 || n == 1);
  }
  if (!flat) {
    fail(
        ErrorCode::kUnsupported, path,
        fmt::format(
            "{}-D image {}; expected 3-D; extract one time step first, with 3D Slicer or ImageJ for instance",
            header.dim[0], size));
  }
  if (!(header.vox_offset >= static_cast<double>(header_bytes) && header.vox_offset < 1e12)) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("vox_offset is {}; expected {} or more", header.vox_offset, header_bytes + 4));
  }
}

/// Rows of a 3x4 affine, voxel index to RAS in the file's units.
using Affine = std::array<double, 12>;

Affine qform_affine(const NiftiHeader& header) {
  auto [b, c, d, x, y, z] = header.quaternion;
  double a = 1 - (b * b + c * c + d * d);
  if (a < 1e-7) {  // rounded: a rotation by 180 degrees
    const double scale = 1 / std::sqrt(b * b + c * c + d * d);
    b *= scale;
    c *= scale;
    d *= scale;
    a = 0;
  } else {
    a = std::sqrt(a);
  }
  const double sx = header.pixdim[1];
  const double sy = header.pixdim[2];
  const double sz = header.pixdim[3] * (header.pixdim[0] < 0 ? -1 : 1);
  return {(a * a + b * b - c * c - d * d) * sx,
          2 * (b * c - a * d) * sy,
          2 * (b * d + a * c) * sz,
          x,
          2 * (b * c + a * d) * sx,
          (a * a + c * c - b * b - d * d) * sy,
          2 * (c * d - a * b) * sz,
          y,
          2 * (b * d - a * c) * sx,
          2 * (c * d + a * b) * sy,
          (a * a + d * d - c * c - b * b) * sz,
          z};
}

bool is_finite(const Affine& m) {
  for (const double v : m) {
    if (!std::isfinite(v)) return false;
  }
  return true;
}

/// True when the columns have length and are perpendicular within about a degree.
bool is_rigid(const Affine& m) {
  if (!is_finite(m)) return false;
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      const auto dot = [&](int i, int j) { return m[i] * m[j] + m[4 + i] * m[4 + j] + m[8 + i] * m[8 + j]; };
      const double lengths = std::sqrt(dot(a, a) * dot(b, b));
      if (!(lengths > 0) || (a != b && std::abs(dot(a, b)) > 0.0175 * lengths)) return false;
    }
  }
  return true;
}

bool differ(const Affine& m, const Affine& n, const NiftiHeader& header) {
  // At the far corner, by more than half a voxel.
  double most = 0;
  double voxel = 0;
  for (int r = 0; r < 3; ++r) {
    double gap = std::abs(m[4 * r + 3] - n[4 * r + 3]);
    for (int a = 0; a < 3; ++a) {
      gap += std::abs(m[4 * r + a] - n[4 * r + a]) *
             static_cast<double>(std::max<std::int64_t>(header.dim[a + 1], 1));
      voxel = std::max(voxel, std::abs(m[4 * r + a]));
    }
    most = std::max(most, gap);
  }
  return most > 0.5 * voxel;
}

void check_pixdim(const std::filesystem::path& path, const NiftiHeader& header) {
  for (std::size_t a = 1; a <= 3 && static_cast<std::int64_t>(a) <= header.dim[0]; ++a) {
    if (!(std::isfinite(header.pixdim[a]) && header.pixdim[a] > 0)) {
      fail(ErrorCode::kBadFormat, path,
           fmt::format("pixdim[{}] is {}; expected a spacing above 0", a, header.pixdim[a]));
    }
  }
}

Affine choose_affine(const std::filesystem::path& path, NiftiHeader header, Volume& volume) {
  for (std::size_t a = static_cast<std::size_t>(header.dim[0]) + 1; a <= 3; ++a) header.pixdim[a] = 1;
  const Affine qform = qform_affine(header);
  if (header.sform_code > 0 && is_rigid(header.srow)) {
    if (header.qform_code > 0 && is_finite(qform) && differ(header.srow, qform, header)) {
      volume.warnings.push_back(
          "the NIfTI header's sform and qform disagree about the place of voxels; the sform is used");
    }
    return header.srow;
  }
  check_pixdim(path, header);
  if (header.qform_code > 0) {
    if (header.sform_code > 0) {
      volume.warnings.push_back("the NIfTI header's sform is sheared or singular; the qform is used");
    }
    return qform;
  }
  if (header.sform_code > 0) return header.srow;  // the geometry check says what is wrong with it
  volume.warnings.push_back(
      "the NIfTI header gives no orientation; axes to the right, front and head are assumed");
  return {header.pixdim[1], 0, 0, 0, 0, header.pixdim[2], 0, 0, 0, 0, header.pixdim[3], 0};
}

}  // namespace

NiftiHeader read_nifti_header(const std::filesystem::path& path, bool deflated) {
  std::vector<unsigned char> bytes = read_start(path, deflated, kBytes1);
  const auto size = Fields(bytes, false).at<std::uint32_t>(0);
  const bool swapped = size == __builtin_bswap32(kBytes1) || size == __builtin_bswap32(kBytes2);
  const std::uint32_t header_bytes = swapped ? __builtin_bswap32(size) : size;
  const bool second = header_bytes == kBytes2;
  if (second) bytes = read_start(path, deflated, kBytes2);
  const unsigned char* magic = bytes.data() + (second ? 4 : 344);
  if (std::memcmp(magic, second ? "ni2" : "ni1", 4) == 0) {
    fail(ErrorCode::kUnsupported, path,
         "NIfTI header with a separate .img file; expected a single .nii file");
  }
  if ((header_bytes != kBytes1 && !second) || std::memcmp(magic, second ? "n+2" : "n+1", 4) != 0) {
    fail(ErrorCode::kBadFormat, path, "not a NIfTI file; expected a 348-byte header ending in \"n+1\"");
  }
  const Fields fields(bytes, swapped);
  NiftiHeader header = second ? parse_version_2(fields) : parse_version_1(fields);
  header.swapped = swapped;
  check(path, header, header_bytes);
  return header;
}

void place_nifti(const std::filesystem::path& path, const NiftiHeader& header, Volume& volume) {
  const int length_unit = header.units & 7;
  const double mm = length_unit == 1 ? 1000 : length_unit == 3 ? 1e-3 : 1;
  const Affine affine = choose_affine(path, header, volume);
  std::array<double, 9> mm_per_voxel{};
  for (int r = 0; r < 3; ++r) {
    const double sign = r < 2 ? -mm : mm;  // RAS to LPS
    // + 0.0 turns a negative zero into zero.
    volume.origin_mm[r] = sign * affine[4 * r + 3] + 0.0;
    for (int a = 0; a < 3; ++a) mm_per_voxel[3 * r + a] = sign * affine[4 * r + a] + 0.0;
  }
  set_axes(volume, mm_per_voxel);
}

}  // namespace voxlume
