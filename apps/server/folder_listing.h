#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "server/roots.h"

namespace voxlume::server {

/// What is in a folder below the first root, by its path from there ("" is the root itself): {"path",
/// "entries": [{"name", "path", "kind", "bytes"}]}, folders first. Hidden files and what leads outside are
/// left out. Throws Error, those of Roots::resolve(), kFileNotFound where it is no folder.
nlohmann::json folder_listing(const Roots& roots, const std::string& path);

}  // namespace voxlume::server
