#include "volume_io/fail.h"

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
  // "/path/itkSomeImageIO.cxx:123: " at the start
  const std::size_t source = text.find(".cxx:");
  const std::size_t source_end = text.find(": ", source == std::string::npos ? 0 : source);
  if (source != std::string::npos && source < text.find(' ') && source_end != std::string::npos) {
    text.erase(0, source_end + 2);
  }
  for (const std::string_view noise : {"ITK ERROR: ", "itk::ERROR: ", "ITK Error: "}) {
    if (const std::size_t at = text.find(noise); at != std::string::npos) text.erase(at, noise.size());
  }
  // "SomeImageIO(0x5581a0): "
  for (std::size_t at = text.find("(0x"); at != std::string::npos; at = text.find("(0x")) {
    const std::size_t end = text.find("): ", at);
    if (end == std::string::npos) break;
    const std::size_t space = text.rfind(' ', at);
    const std::size_t start = space == std::string::npos ? 0 : space + 1;
    text.erase(start, end + 3 - start);
  }
  return text;
}

void fail(ErrorCode code, const std::filesystem::path& where, std::string_view message) {
  throw Error(code, one_line(where.string()), one_line(message));
}

}  // namespace voxlume
