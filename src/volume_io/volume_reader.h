#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "base/progress.h"
#include "volume_io/file_map.h"
#include "voxlume/volume.h"

namespace voxlume {

/// 64-bit integers have no VoxelType: they are read as they are and narrowed to i32 when every value fits.
enum class WideInteger : std::uint8_t { kNone, kI64, kU64 };

inline constexpr const char* kNarrowedWarning = "64-bit integers were narrowed to 32 bits (every value fits)";

/// What a file says of itself before any voxel is read.
struct VolumeHeader {
  Volume volume;  ///< voxels is null; type is kI32 for wide integers
  WideInteger wide = WideInteger::kNone;
  std::uint64_t working_bytes = 0;  ///< what read_voxels allocates besides the voxels, at most

  /// Bytes read_voxels writes; more than volume.byte_count() for wide integers.
  std::uint64_t stored_bytes() const {
    return static_cast<std::uint64_t>(volume.voxel_count()) *
           (wide == WideInteger::kNone ? voxel_bytes(volume.type) : 8);
  }
};

/// Reads one volume: the header first, so that memory can be checked before it is allocated. Both calls throw
/// Error, or whatever the library beneath throws (the caller turns that into kBadFormat).
class VolumeReader {
 public:
  virtual ~VolumeReader() = default;
  /// Sizes are >= 1; geometry is as the file has it, not yet checked. `progress`, here and below, may be
  /// empty; readers of many files tell of those that they have looked at, the others of nothing.
  virtual VolumeHeader read_header(const Progress& progress) = 0;
  /// Where the file itself has the voxels in the header's type and the machine's byte order; none when they
  /// must be read. To be asked after read_header, which has seen that the file is long enough.
  virtual std::optional<VoxelsInFile> voxels_in_file() const { return std::nullopt; }
  /// Called at most once, after read_header. `voxels` has room for stored_bytes() and is zero. Tells of the
  /// share of the voxels that is there, where that is known.
  virtual void read_voxels(void* voxels, const Progress& progress) = 0;
};

/// The reader of the format of `path`, which is an existing file or folder.
/// Throws Error kUnsupported when the format is not known, kBadFormat when the file is empty.
std::unique_ptr<VolumeReader> open_reader(const std::filesystem::path& path);

}  // namespace voxlume
