#pragma once
#include <filesystem>
#include <memory>
#include <vector>

#include "volume_io/volume_reader.h"

namespace voxlume {

/// Reads the pages of one TIFF file as the slices of a volume, or, given several files, the one page of each
/// in the order given. Pages must agree in size and type and have one channel. Spacing comes from an ImageJ
/// or OME description or the resolution tags; a warning says what had to be assumed.
std::unique_ptr<VolumeReader> make_tiff_reader(std::vector<std::filesystem::path> files);

}  // namespace voxlume
