#include "render/frame_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

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

std::vector<int> FramePattern::frames_on_disk() const {
  std::vector<int> frames;
  std::error_code failed;
  std::filesystem::directory_iterator files(folder_.empty() ? "." : folder_, failed);
  for (; !failed && files != std::filesystem::directory_iterator(); files.increment(failed)) {
    const std::string name = files->path().filename().string();
    if (name.size() < before_.size() + after_.size()) continue;
    int frame = 0;
    const auto [stop, error] =
        std::from_chars(name.data() + before_.size(), name.data() + name.size(), frame);
    if (error == std::errc{} && frame >= 0 && path(frame).filename().string() == name)
      frames.push_back(frame);
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

}  // namespace voxlume
