#include "volume_io/file_map.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>

#include "base/fail.h"

static_assert(std::endian::native == std::endian::little, "files are mapped as little-endian voxels");

namespace voxlume {

bool is_aligned(std::uint64_t offset_bytes, VoxelType type) { return offset_bytes % voxel_bytes(type) == 0; }

std::shared_ptr<const void> map_voxels(const VoxelsInFile& place, const Volume& volume) {
  // Without O_NONBLOCK, a pipe put in the file's place would be waited for.
  const int file = open(place.path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) fail(ErrorCode::kFileNotFound, place.path, "cannot open this file for reading");
  const std::uint64_t bytes = volume.byte_count();
  struct stat status {};
  const bool is_file = fstat(file, &status) == 0 && S_ISREG(status.st_mode);
  const std::uint64_t file_bytes = is_file ? static_cast<std::uint64_t>(status.st_size) : 0;
  const bool is_long_enough = place.offset_bytes <= file_bytes && bytes <= file_bytes - place.offset_bytes;
  const std::size_t length = place.offset_bytes + bytes;
  void* start = is_long_enough ? mmap(nullptr, length, PROT_READ, MAP_PRIVATE, file, 0) : MAP_FAILED;
  close(file);
  if (!is_long_enough) {
    fail(ErrorCode::kBadFormat, place.path,
         is_file ? fmt::format("expected {} bytes ({} {} voxels after offset {}), file has {}", length,
                               fmt::join(volume.size, "x"), voxel_type_name(volume.type), place.offset_bytes,
                               file_bytes)
                 : "not a file; expected one with voxels");
  }
  if (start == MAP_FAILED)
    fail(ErrorCode::kOutOfMemory, place.path, fmt::format("cannot map {} bytes", length));
  std::shared_ptr<const void> owner(start, [length](const void* p) { munmap(const_cast<void*>(p), length); });
  return {owner, static_cast<const unsigned char*>(start) + place.offset_bytes};
}

}  // namespace voxlume
