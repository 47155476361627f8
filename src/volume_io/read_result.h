#pragma once
#include <string>

#include "volume_io/staged_read.h"
#include "voxlume/error.h"

namespace voxlume {

/// One line of JSON: a volume without its voxels but with their place when they are in a file, or an error.
/// decode_result gives the volume back, with voxels null, or throws the Error; it throws kInternal when the
/// line is neither.
std::string encode_volume(const StagedVolume& staged);
std::string encode_error(const Error& error);
StagedVolume decode_result(const std::string& line);

}  // namespace voxlume
