#include "volume_io/staged_read.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <optional>
#include <utility>

#include "base/fail.h"
#include "volume_io/geometry_check.h"
#include "volume_io/library_message.h"
#include "volume_io/memory_limit.h"
#include "volume_io/volume_reader.h"
#include "volume_io/voxel_convert.h"

namespace voxlume {
namespace {

/// What looking at every file of a series takes of reading it.
constexpr double kHeaderShare = 0.2;

StagedVolume read_steps(const std::filesystem::path& path, const ReadOptions& options,
                        const AllocateVoxels& allocate) {
  const std::unique_ptr<VolumeReader> reader = open_reader(path);
  double looked_at = 0;  // as a share of all reading
  const auto within = [&](auto&& share_of_all) -> Progress {
    if (!options.progress) return {};
    return [&options, share_of_all](double share) { options.progress(share_of_all(share)); };
  };
  VolumeHeader header =
      reader->read_header(within([&](double share) { return looked_at = kHeaderShare * share; }));
  Volume& volume = header.volume;
  if (options.spacing_mm) volume.spacing_mm = *options.spacing_mm;
  check_geometry(path, volume);
  const std::uint64_t bytes = header.stored_bytes();
  const std::optional<VoxelsInFile> in_file = reader->voxels_in_file();
  if (in_file && header.wide == WideInteger::kNone && is_aligned(in_file->offset_bytes, volume.type)) {
    if (options.memory_limit_bytes > 0) check_memory(path, volume, bytes, options.memory_limit_bytes);
    return {std::move(volume), in_file};
  }
  check_memory(path, volume, bytes, options.memory_limit_bytes);
  check_memory(path, volume, bytes + header.working_bytes, 0);
  const std::shared_ptr<void> voxels = allocate(bytes, header.working_bytes);
  reader->read_voxels(voxels.get(),
                      within([&](double share) { return looked_at + (1 - looked_at) * share; }));
  narrow_wide_integers(path, header.wide, voxels.get(), volume.voxel_count());
  volume.voxels = voxels;
  return {std::move(volume), std::nullopt};
}

}  // namespace

StagedVolume read_staged(const std::filesystem::path& path, const ReadOptions& options,
                         const AllocateVoxels& allocate) {
  try {
    return read_steps(path, options, allocate);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("the reader of {} needed more memory than the file should take (damaged?)",
                     reader_name(path)));
  } catch (const std::exception& error) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("the reader of {} failed: {}", reader_name(path), library_message(error.what())));
  } catch (...) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("the reader of {} failed on this file (damaged?)", reader_name(path)));
  }
}

}  // namespace voxlume
