#pragma once
#include <filesystem>
#include <shared_mutex>

#include "voxlume/volume_io.h"

namespace voxlume {

/// Reads in a forked child process, since the format libraries can crash or allocate without bound on a
/// damaged file. The child writes the voxels into shared memory that becomes Volume::voxels, or finds that
/// the file has them as they are needed, and they are mapped from there: there is one copy of them at most.
/// Errors are those of read_volume; a child that crashes or hangs gives kBadFormat.
Volume read_isolated(const std::filesystem::path& path, const ReadOptions& options);

/// The same reading without the child, for fuzzing: what crashes, crashes here.
Volume read_in_process(const std::filesystem::path& path, const ReadOptions& options);

/// Held shared while this process uses ITK or OpenVDB itself (writing), and exclusively while it forks: a
/// lock of theirs held by another thread would stay locked for ever in the child.
std::shared_mutex& library_mutex();

}  // namespace voxlume
