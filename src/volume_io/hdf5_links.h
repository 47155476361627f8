#pragma once
#include <filesystem>

namespace voxlume {

/// Throws Error kUnsupported where an HDF5 file has links to other files, or data that is stored in them:
/// what is opened is to be the file that was named. kBadFormat where it cannot be looked through; nothing for
/// what is no HDF5 file at all, of which its reader says more.
void check_hdf5_is_one_file(const std::filesystem::path& path);

}  // namespace voxlume
