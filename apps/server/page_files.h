#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace voxlume::server {

/// A file of the page.
struct PageFile {
  std::filesystem::path path;
  std::string type;  ///< its content type
  std::string tag;   ///< differs when the file does
};

/// The page as it lies in a folder.
class PageFiles {
 public:
  /// The folder that a page is served from: VOXLUME_PAGE of the environment, or beside the program, in
  /// ../web or ../share/voxlume/web; empty where no page is.
  static std::filesystem::path find(const std::filesystem::path& program);

  explicit PageFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}

  bool exists() const;
  /// The file of a request's path ("/" is index.html); empty where there is none in the folder. Names with
  /// anything but letters, digits, and ._-/ are none.
  std::optional<PageFile> file(std::string_view request_path) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace voxlume::server
