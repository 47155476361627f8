#pragma once
#include <filesystem>
#include <memory>
#include <vector>

#include "volume_io/volume_reader.h"

namespace voxlume {

/// Reads the largest series among `files`: slices ordered by position along their normal, values rescaled to
/// the modality's units. Warnings list the other series and everything that makes the stack uneven. `where`
/// names the folder or file in errors.
std::unique_ptr<VolumeReader> make_dicom_reader(const std::filesystem::path& where,
                                                std::vector<std::filesystem::path> files);

/// True when at least one of the files begins like a DICOM file.
bool has_dicom(const std::vector<std::filesystem::path>& files);

}  // namespace voxlume
