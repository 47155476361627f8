#pragma once
#include <string_view>

namespace voxlume {

/// Orders names as people do: runs of digits by their number, so that "slice9" comes before "slice10".
bool natural_less(std::string_view a, std::string_view b);

}  // namespace voxlume
