#pragma once
#include <string>

#include "voxlume/error.h"
#include "voxlume/volume.h"

namespace voxlume {

/// One line of JSON: a volume without its voxels, or an error. decode_result gives the volume back, with
/// voxels null, or throws the Error; it throws kInternal when the line is neither.
std::string encode_volume(const Volume& volume);
std::string encode_error(const Error& error);
Volume decode_result(const std::string& line);

}  // namespace voxlume
