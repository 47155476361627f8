#include "cli/output_file.h"

#include <unistd.h>

#include <charconv>

#include "base/file_extension.h"
#include "scene/field_info.h"
#include "voxlume/error.h"

namespace voxlume::cli {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse_frames(const std::string& text, const std::string& expected) {
  throw Error(ErrorCode::kBadParameter, "--frames", "found " + quote_text(text) + ", expected " + expected);
}

/// Throws unless `text` is a frame's number.
int frame_number(std::string_view text, const std::string& whole) {
  int number = 0;
  const auto [stop, failed] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (failed != std::errc{} || stop != text.data() + text.size() || number < 0)
    refuse_frames(whole, "A:B, first and last frame, or one number");
  return number;
}

}  // namespace

PictureFormat picture_format(const fs::path& path, const std::string& flag) {
  const std::string extension = lower_extension(path);
  if (extension == ".png") return PictureFormat::kPng;
  if (extension == ".exr") return PictureFormat::kExr;
  throw Error(ErrorCode::kUnsupported, flag,
              "found " + quote_text(path.string()) +
                  ", expected a name ending in .png or .exr (or .mp4 or .webm, for an animation)");
}

void check_writable(const fs::path& path, const std::string& flag) {
  const auto refuse = [&](const std::string& message) {
    throw Error(ErrorCode::kBadParameter, flag, "cannot write " + quote_text(path.string()) + ": " + message);
  };
  std::error_code ignored;
  if (path.filename().empty()) refuse("expected a file name");
  if (fs::is_directory(path, ignored)) refuse("it is a folder");
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored))
    refuse("the folder " + quote_text(folder.string()) + " does not exist");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    refuse("the folder " + quote_text(folder.string()) + " is not writable");
}

void check_not_input(const fs::path& output, const std::vector<std::string>& inputs,
                     const std::string& flag) {
  for (const std::string& input : inputs) {
    std::error_code ignored;
    if (!fs::equivalent(output, input, ignored)) continue;
    throw Error(ErrorCode::kBadParameter, flag,
                quote_text(output.string()) + " is an input of this command; expected another name");
  }
}

FrameRange frame_range(const std::string& text, const FrameRange& all) {
  FrameRange range = all;
  const std::size_t colon = text.find(':');
  const std::string first = text.substr(0, colon);
  const std::string last = colon == std::string::npos ? first : text.substr(colon + 1);
  if (!first.empty()) range.first = frame_number(first, text);
  if (!last.empty()) range.last = frame_number(last, text);
  if (range.first < all.first || range.last > all.last || range.first > range.last)
    refuse_frames(text, "frames from " + std::to_string(all.first) + " to " + std::to_string(all.last));
  return range;
}

}  // namespace voxlume::cli
