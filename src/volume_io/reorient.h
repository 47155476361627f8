#pragma once
#include <filesystem>

#include "voxlume/volume.h"

namespace voxlume {

/// The same volume with its voxels reordered so that the index axes run along +x, +y and +z of LPS: for
/// formats that carry no orientation, whose readers would otherwise show a mirrored patient. A volume that is
/// so already is returned as it is. Throws Error kUnsupported, naming `path`, for an oblique one.
Volume along_lps_axes(const std::filesystem::path& path, const Volume& volume);

}  // namespace voxlume
