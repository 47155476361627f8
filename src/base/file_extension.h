#pragma once
#include <filesystem>
#include <string>

namespace voxlume {

/// ".png" of "a/B.PNG": the extension in lower case, empty where there is none.
inline std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

}  // namespace voxlume
