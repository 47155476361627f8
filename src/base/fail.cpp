#include "base/fail.h"

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

void fail(ErrorCode code, const std::filesystem::path& where, std::string_view message) {
  throw Error(code, one_line(where.string()), one_line(message));
}

}  // namespace voxlume
