#pragma once
#include <string>
#include <string_view>

namespace voxlume {

/// What a library says in an exception, without its source file, line, class name and address.
std::string library_message(std::string_view what);

}  // namespace voxlume
