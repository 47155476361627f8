#include "render/frame_files.h"

#include <fmt/format.h>

#include "voxlume/error.h"

namespace voxlume {

bool FramePattern::is_pattern(const std::filesystem::path& path) {
  return path.filename().string().find('#') != std::string::npos;
}

FramePattern::FramePattern(const std::filesystem::path& path, const std::string& where)
    : folder_(path.parent_path()) {
  const std::string name = path.filename().string();
  const std::size_t begin = name.find('#');
  const std::size_t end = name.find_first_not_of('#', begin);
  if (begin == std::string::npos || (end != std::string::npos && name.find('#', end) != std::string::npos))
    throw Error(ErrorCode::kBadParameter, where,
                "expected one run of # for the frame's number, such as frame-####.png");
  before_ = name.substr(0, begin);
  after_ = end == std::string::npos ? "" : name.substr(end);
  digits_ = static_cast<int>(name.size() - before_.size() - after_.size());
}

std::filesystem::path FramePattern::path(int frame) const {
  return folder_ / fmt::format("{}{:0{}}{}", before_, frame, digits_, after_);
}

}  // namespace voxlume
