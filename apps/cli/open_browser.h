#pragma once
#include <string>

namespace voxlume::cli {

/// Asks the desktop to open `url` in the user's web browser; does nothing where there is no desktop. Does not
/// wait.
void open_browser(const std::string& url);

}  // namespace voxlume::cli
