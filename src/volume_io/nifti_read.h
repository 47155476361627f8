#pragma once
#include <filesystem>
#include <memory>

#include "volume_io/volume_reader.h"

namespace voxlume {

/// Reads NIfTI-1 and NIfTI-2 single files, plain or gzipped, without ITK: its reader holds the voxels twice
/// and, where sform and qform differ, does not always take the sform as other software does. Scaled values
/// become f32 or f64.
std::unique_ptr<VolumeReader> make_nifti_reader(const std::filesystem::path& path);

}  // namespace voxlume
