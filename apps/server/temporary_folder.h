#pragma once
#include <filesystem>

namespace voxlume::server {

/// A folder of this process alone, removed with everything in it.
class TemporaryFolder {
 public:
  /// Throws Error kInternal where none can be made.
  TemporaryFolder();
  ~TemporaryFolder() { remove(); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Now, and not only at the end.
  void remove();

 private:
  std::filesystem::path path_;
};

}  // namespace voxlume::server
