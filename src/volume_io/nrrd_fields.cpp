#include "volume_io/nrrd_fields.h"

#include <cctype>
#include <fstream>

namespace voxlume {

NrrdFields read_nrrd_fields(const std::filesystem::path& path) {
  constexpr int kMaxLines = 1000;
  NrrdFields fields;
  std::ifstream file(path, std::ios::binary);
  std::string line;
  for (int i = 0; i < kMaxLines && std::getline(file, line); ++i) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) {
      fields.header_bytes = static_cast<std::uint64_t>(file.tellg());
      break;
    }
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos || line[0] == '#') continue;
    std::string name;
    for (const char c : line.substr(0, colon)) {
      if (c != ' ') name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    std::string value = line.substr(colon + 2);
    while (!value.empty() && value.back() == ' ') value.pop_back();
    while (!value.empty() && value.front() == ' ') value.erase(value.begin());
    fields.values[name] = value;
  }
  return fields;
}

}  // namespace voxlume
