#include "volume_io/library_message.h"

#include "base/fail.h"

namespace voxlume {

std::string library_message(std::string_view what) {
  // teem names the function that failed and all that called it; the last one knows the reason.
  if (const std::size_t last = what.rfind("[nrrd] "); last != std::string::npos) {
    const std::size_t reason = what.find(": ", last);
    what.remove_prefix(reason == std::string::npos ? last : reason + 2);
  }
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

}  // namespace voxlume
