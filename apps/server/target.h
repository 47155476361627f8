#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace voxlume::server {

/// What a request asks for: "/api/slice?axis=x&mm=3", taken apart.
struct Target {
  std::string path;                          ///< decoded
  std::map<std::string, std::string> query;  ///< decoded; of a key given twice the last

  /// Empty where it is not given.
  std::string value(const std::string& key) const;
};

/// Empty where an escape is wrong, there is a zero byte, or it does not start with a slash.
std::optional<Target> parse_target(std::string_view target);

/// %41 and (of queries) + decoded. Empty where an escape is wrong or a byte is zero.
std::optional<std::string> percent_decoded(std::string_view text, bool plus_is_space);

}  // namespace voxlume::server
