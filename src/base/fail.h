#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "voxlume/error.h"

namespace voxlume {

/// The text as one line: control characters and runs of blanks become one blank; longer than 400 bytes is
/// cut.
std::string one_line(std::string_view text);

/// Throws Error with `where` and `message` made one line.
[[noreturn]] void fail(ErrorCode code, const std::filesystem::path& where, std::string_view message);

}  // namespace voxlume
