#include "volume_io/fail.h"

#include <regex>

namespace voxlume {

std::string one_line(std::string_view text) {
  constexpr std::size_t kMaxBytes = 400;
  std::string line;
  for (const char c : text) {
    const bool blank = static_cast<unsigned char>(c) <= ' ' || c == '\x7f';
    if (!blank) {
      line += c;
    } else if (!line.empty() && line.back() != ' ') {
      line += ' ';
    }
    if (line.size() == kMaxBytes) {
      line += "...";
      break;
    }
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

std::string library_message(std::string_view what) {
  std::string text = one_line(what);
  static const std::regex kSource(R"(^\S+:\d+:? )");
  static const std::regex kObject(R"((ITK ERROR|ITK Error|itk::ERROR): ?|\w+\(0x[0-9a-fA-F]+\): ?)");
  text = std::regex_replace(text, kSource, "", std::regex_constants::format_first_only);
  return std::regex_replace(text, kObject, "");
}

void fail(ErrorCode code, const std::filesystem::path& where, std::string_view message) {
  throw Error(code, one_line(where.string()), one_line(message));
}

}  // namespace voxlume
