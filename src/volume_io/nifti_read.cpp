#include "volume_io/nifti_read.h"

#include <fmt/format.h>

#include <cmath>

#include "base/fail.h"
#include "volume_io/file_format.h"
#include "volume_io/nifti_header.h"
#include "volume_io/voxel_convert.h"
#include "volume_io/voxel_stream.h"

namespace voxlume {
namespace {

/// How a NIfTI datatype code is stored.
struct Datatype {
  int code;
  VoxelType type;
  WideInteger wide;
};

constexpr Datatype kDatatypes[] = {
    {2, VoxelType::kU8, WideInteger::kNone},    {4, VoxelType::kI16, WideInteger::kNone},
    {8, VoxelType::kI32, WideInteger::kNone},   {16, VoxelType::kF32, WideInteger::kNone},
    {64, VoxelType::kF64, WideInteger::kNone},  {256, VoxelType::kI8, WideInteger::kNone},
    {512, VoxelType::kU16, WideInteger::kNone}, {768, VoxelType::kU32, WideInteger::kNone},
    {1024, VoxelType::kI32, WideInteger::kI64}, {1280, VoxelType::kI32, WideInteger::kU64},
};

const char* unsupported_name(int code) {
  switch (code) {
    case 1:
      return "single bits";
    case 128:
    case 2304:
      return "RGB colours";
    case 32:
    case 1792:
    case 2048:
      return "complex numbers";
    case 1536:
      return "128-bit floating point";
    default:
      return "an unknown type";
  }
}

const Datatype& find_datatype(const std::filesystem::path& path, int code) {
  for (const Datatype& row : kDatatypes) {
    if (row.code == code) return row;
  }
  fail(ErrorCode::kUnsupported, path,
       fmt::format("voxels are {} (NIfTI datatype {}); expected one integer or floating point number each",
                   unsupported_name(code), code));
}

class NiftiReader : public VolumeReader {
 public:
  explicit NiftiReader(const std::filesystem::path& path) : path_(path) {}

  VolumeHeader read_header(const Progress&) override {
    deflated_ = starts_with_gzip(path_);
    nifti_ = read_nifti_header(path_, deflated_);
    VolumeHeader header;
    Volume& volume = header.volume;
    volume.format = format_name(FileFormat::kNifti);
    for (std::size_t a = 0; a < 3; ++a)
      volume.size[a] = static_cast<std::int64_t>(a) < nifti_.dim[0] ? nifti_.dim[a + 1] : 1;
    place_nifti(path_, nifti_, volume);
    choose_type(header);
    count_ = volume.voxel_count();
    check_size();
    return header;
  }

  std::optional<VoxelsInFile> voxels_in_file() const override {
    const bool swapped = nifti_.swapped && stored_bytes_ > 1;
    if (deflated_ || scaled_ || swapped) return std::nullopt;
    return VoxelsInFile{path_, static_cast<std::uint64_t>(nifti_.vox_offset)};
  }

  void read_voxels(void* voxels, const Progress& progress) override {
    // Stored values narrower than the result are put at its end and widened from the front.
    const std::uint64_t bytes = count_ * stored_bytes_;
    const std::uint64_t room = scaled_ ? count_ * voxel_bytes(type_) : bytes;
    void* stored = static_cast<unsigned char*>(voxels) + (room - bytes);
    const auto offset = static_cast<std::uint64_t>(nifti_.vox_offset);
    if (deflated_) {
      read_deflated(path_, 0, offset, stored, bytes, progress);
    } else {
      read_plain(path_, offset, stored, bytes, progress);
    }
    if (nifti_.swapped) swap_bytes(stored, count_, stored_bytes_);
    if (scaled_) rescale_voxels(stored, stored_type_, voxels, type_, count_, nifti_.slope, nifti_.intercept);
  }

 private:
  /// The file's own type or, when its values are scaled, f32 (f64 for f64).
  void choose_type(VolumeHeader& header) {
    const Datatype& datatype = find_datatype(path_, nifti_.datatype);
    const bool has_slope =
        std::isfinite(nifti_.slope) && nifti_.slope != 0 && std::isfinite(nifti_.intercept);
    scaled_ = has_slope && (nifti_.slope != 1 || nifti_.intercept != 0);
    header.wide = datatype.wide;
    stored_type_ = type_ = datatype.type;
    stored_bytes_ = voxel_bytes(stored_type_);
    if (header.wide != WideInteger::kNone) {
      if (scaled_)
        fail(ErrorCode::kUnsupported, path_, "scaled 64-bit integers; convert to floating point first");
      stored_bytes_ = 8;
      header.volume.warnings.push_back(kNarrowedWarning);
    }
    if (scaled_ && type_ != VoxelType::kF64) type_ = VoxelType::kF32;
    header.volume.type = type_;
  }

  void check_size() const {
    const std::uint64_t file_bytes = std::filesystem::file_size(path_);
    const auto offset = static_cast<std::uint64_t>(nifti_.vox_offset);
    // In floating point: a damaged header may promise more than 64 bits count.
    const double expected = static_cast<double>(stored_bytes_) * static_cast<double>(nifti_.dim[1]) *
                            (nifti_.dim[0] > 1 ? static_cast<double>(nifti_.dim[2]) : 1) *
                            (nifti_.dim[0] > 2 ? static_cast<double>(nifti_.dim[3]) : 1);
    if (expected > 0x1p60)
      fail(ErrorCode::kBadFormat, path_, "the header promises more voxels than can exist");
    const std::uint64_t data_bytes = file_bytes - std::min(offset, file_bytes);
    if (deflated_) return check_deflated_size(path_, file_bytes, count_ * stored_bytes_);
    if (data_bytes < count_ * stored_bytes_) {
      fail(ErrorCode::kBadFormat, path_,
           fmt::format("expected {} bytes of voxels, file has {}", count_ * stored_bytes_, data_bytes));
    }
  }

  std::filesystem::path path_;
  NiftiHeader nifti_;
  bool deflated_ = false;
  bool scaled_ = false;
  std::uint64_t count_ = 0;
  std::size_t stored_bytes_ = 1;
  VoxelType stored_type_ = VoxelType::kU8;
  VoxelType type_ = VoxelType::kU8;
};

}  // namespace

std::unique_ptr<VolumeReader> make_nifti_reader(const std::filesystem::path& path) {
  return std::make_unique<NiftiReader>(path);
}

}  // namespace voxlume
