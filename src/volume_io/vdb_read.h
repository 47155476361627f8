#pragma once
#include <filesystem>
#include <memory>

#include "volume_io/volume_reader.h"

namespace voxlume {

/// Reads the first float grid of an OpenVDB file as the dense f32 box of its active voxels; world units are
/// taken for millimetres. Throws Error kUnsupported when built without OpenVDB.
std::unique_ptr<VolumeReader> make_vdb_reader(const std::filesystem::path& path);

}  // namespace voxlume
