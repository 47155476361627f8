#pragma once
#include <array>
#include <cstdint>
#include <filesystem>

#include "voxlume/volume.h"

namespace voxlume {

/// The fields of a NIfTI-1 or NIfTI-2 header that describe voxels and place, in the file's units (RAS).
struct NiftiHeader {
  bool swapped = false;  ///< numbers are big-endian
  std::array<std::int64_t, 8> dim{};
  int datatype = 0;
  std::array<double, 8> pixdim{};
  double vox_offset = 0;
  double slope = 0;
  double intercept = 0;
  int units = 0;
  int qform_code = 0;
  int sform_code = 0;
  std::array<double, 6> quaternion{};  ///< b, c, d and the offsets x, y, z
  std::array<double, 12> srow{};
};

/// Throws Error kBadFormat when the file does not begin with a single-file NIfTI header ("n+1", "n+2") whose
/// dimensions are possible, kUnsupported for a header with a separate .img file.
NiftiHeader read_nifti_header(const std::filesystem::path& path, bool deflated);

/// Sets spacing, origin and direction (LPS, mm): from the sform where there is one that is not sheared, else
/// from the qform, else axes along right, anterior, superior. Warns when the two disagree or neither is
/// there. Throws Error kBadFormat for a spacing that is needed and not above 0.
void place_nifti(const std::filesystem::path& path, const NiftiHeader& header, Volume& volume);

}  // namespace voxlume
