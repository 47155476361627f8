#include "cli/output_file.h"

#include <unistd.h>

#include "base/file_extension.h"
#include "scene/field_info.h"
#include "voxlume/error.h"

namespace voxlume::cli {

namespace fs = std::filesystem;

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

}  // namespace voxlume::cli
