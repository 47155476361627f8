#pragma once
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "voxlume/scene.h"

namespace voxlume::server {

/// The part of the disk that pages may name: what is below some folders, and single files and folders that
/// the user named himself.
class Roots {
 public:
  /// Relative paths start from `folder`, which is the first root. Throws Error kFileNotFound unless it is
  /// one.
  explicit Roots(const std::filesystem::path& folder);

  /// Another root, or a single file. It is left out when it does not exist.
  void add(const std::filesystem::path& path);

  const std::filesystem::path& folder() const { return roots_.front(); }

  /// The canonical, absolute path of a file or folder that may be read. Throws Error, naming `text`:
  /// kBadParameter where it leads outside (by "..", a symbolic link or an absolute path), kFileNotFound
  /// where there is no file or folder. What is outside gets the same answer whether it exists or not.
  std::filesystem::path resolve(const std::string& text) const;

  /// The same for a volume that is to be opened: what a file's header names as the files of its voxels, and
  /// what links in a folder lead to, must be inside as well. Not so of what was added itself.
  std::filesystem::path resolve_to_open(const std::string& text) const;

  /// The files beside a scene's label volumes, whose paths are canonical, that names and colours are read
  /// from must be inside as well. Not so of volumes that were added themselves. Throws Error kBadParameter.
  void check_label_files(const SceneDescription& scene) const;

  /// Makes every path of `scene` absolute and canonical by resolve_to_open(), and looks at its label files.
  /// Paths that `trusted` has as they are stay so. Throws Error, those of resolve().
  void resolve_paths(SceneDescription& scene, const std::set<std::string>& trusted = {}) const;

 private:
  bool contains(const std::filesystem::path& canonical) const;
  /// Whether what a path leads to is in the roots.
  bool leads_inside(const std::filesystem::path& path) const;
  /// Whether it was added itself.
  bool is_named(const std::filesystem::path& canonical) const;

  std::vector<std::filesystem::path> roots_;
};

/// Every path of a scene.
std::set<std::string> scene_paths(SceneDescription scene);

}  // namespace voxlume::server
