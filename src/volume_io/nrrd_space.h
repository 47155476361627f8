#pragma once
#include <filesystem>

#include "volume_io/nrrd_fields.h"
#include "voxlume/volume.h"

namespace voxlume {

/// Completes what ITK makes of an NRRD header's place in space: left-anterior-superior is turned to LPS (ITK
/// before 6 flips the wrong axis), units other than millimetres are converted, and a space without patient
/// directions is warned about. Throws Error kUnsupported for a left-anterior-superior header whose axes are
/// not three vectors.
void complete_nrrd_space(const std::filesystem::path& path, const NrrdFields& fields, Volume& volume);

}  // namespace voxlume
