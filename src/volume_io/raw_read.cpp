#include "volume_io/raw_read.h"

#include <fmt/format.h>

#include <cmath>

#include "base/fail.h"
#include "volume_io/file_map.h"
#include "volume_io/geometry_check.h"
#include "volume_io/memory_limit.h"
#include "volume_io/voxel_stream.h"

namespace voxlume {
namespace {

void check_spec(const std::filesystem::path& path, const RawSpec& spec) {
  double bytes = static_cast<double>(voxel_bytes(spec.type));
  for (const std::int64_t n : spec.size) {
    if (n < 1) {
      fail(ErrorCode::kBadParameter, path,
           fmt::format("raw size {}; expected three sizes of at least 1", fmt::join(spec.size, "x")));
    }
    if (n > kMaxAxisVoxels) {
      fail(ErrorCode::kBadParameter, path,
           fmt::format("raw size {}; expected at most {} along each axis", fmt::join(spec.size, "x"),
                       kMaxAxisVoxels));
    }
    bytes *= static_cast<double>(n);
  }
  if (bytes > 0x1p60 || spec.offset_bytes > (1ull << 60)) {
    fail(ErrorCode::kBadParameter, path, fmt::format("raw size {} is absurd", fmt::join(spec.size, "x")));
  }
  for (const double s : spec.spacing_mm) {
    if (!(std::isfinite(s) && s > 0)) {
      fail(ErrorCode::kBadParameter, path, fmt::format("raw spacing {}; expected numbers above 0 (mm)", s));
    }
  }
}

}  // namespace

Volume read_raw(const std::filesystem::path& path, const RawSpec& spec, std::uint64_t memory_limit_bytes,
                const Progress& progress) {
  check_spec(path, spec);
  Volume volume;
  volume.size = spec.size;
  volume.type = spec.type;
  volume.spacing_mm = spec.spacing_mm;
  volume.format = "raw";
  if (!std::filesystem::is_regular_file(path))
    fail(ErrorCode::kBadFormat, path, "not a file; --raw reads one file");
  const std::uint64_t bytes = volume.byte_count();
  const std::uint64_t file_bytes = std::filesystem::file_size(path);
  const std::uint64_t expected = spec.offset_bytes + bytes;
  if (file_bytes < expected) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("expected {} bytes ({} {} voxels after offset {}), file has {}", expected,
                     fmt::join(spec.size, "x"), voxel_type_name(spec.type), spec.offset_bytes, file_bytes));
  }
  if (file_bytes > expected) {
    volume.warnings.push_back(
        fmt::format("the file has {} bytes more than the raw size and offset use; the type or "
                    "size given may be wrong",
                    file_bytes - expected));
  }
  const bool swapped = spec.big_endian && voxel_bytes(spec.type) > 1;
  if (is_aligned(spec.offset_bytes, spec.type) && !swapped) {
    if (memory_limit_bytes > 0) check_memory(path, volume, bytes, memory_limit_bytes);
    volume.voxels = map_voxels({path, spec.offset_bytes}, volume);
    return volume;
  }
  check_memory(path, volume, bytes, memory_limit_bytes);
  const std::shared_ptr<void> voxels = allocate_voxels(path, bytes);
  read_plain(path, spec.offset_bytes, voxels.get(), bytes, progress);
  if (swapped) swap_bytes(voxels.get(), volume.voxel_count(), voxel_bytes(spec.type));
  volume.voxels = voxels;
  return volume;
}

}  // namespace voxlume
