#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

namespace voxlume {

/// The "field: value" lines of an NRRD header, which ITK does not hand on.
struct NrrdFields {
  std::map<std::string, std::string> values;  ///< by field name in lower case without blanks
  std::uint64_t header_bytes = 0;             ///< where attached data begin

  /// Empty when the field is not there.
  std::string value(const std::string& name) const {
    const auto found = values.find(name);
    return found == values.end() ? "" : found->second;
  }
};

NrrdFields read_nrrd_fields(const std::filesystem::path& path);

}  // namespace voxlume
