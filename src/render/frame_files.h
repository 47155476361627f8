#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace voxlume {

/// Frames [first, last] of an animation, counted from 0.
struct FrameRange {
  int first = 0, last = 0;
  int count() const { return last - first + 1; }
};

/// File names of numbered pictures: a run of # in the name stands for the frame's number, with leading zeros.
class FramePattern {
 public:
  /// Whether the last part of `path` has a # in it.
  static bool is_pattern(const std::filesystem::path& path);

  /// Throws Error kBadParameter at `where` unless the last part of `path` has exactly one run of #.
  FramePattern(const std::filesystem::path& path, const std::string& where);

  /// Longer numbers than there are # take the room they need.
  std::filesystem::path path(int frame) const;

  /// The numbers of the files that are there, ascending; those that path() would write otherwise do not
  /// count.
  std::vector<int> frames_on_disk() const;

 private:
  std::filesystem::path folder_;
  std::string before_, after_;
  int digits_;
};

}  // namespace voxlume
