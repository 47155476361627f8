#pragma once
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "server/roots.h"
#include "server/uploads.h"
#include "voxlume/scene.h"

namespace voxlume::server {

/// The files that scenes and pages name: below the roots, or uploads, which stay as long as a scene needs
/// them.
class SceneFiles {
 public:
  /// `uploads` are below one of the roots.
  SceneFiles(Roots roots, Uploads& uploads) : roots_(std::move(roots)), uploads_(uploads) {}

  const Roots& roots() const { return roots_; }
  const Uploads& uploads() const { return uploads_; }

  /// What a page means by a path that it may read. Throws Error, those of Roots::resolve_to_open() and
  /// Uploads::opened_as(); an upload is given up then.
  std::filesystem::path to_open(const std::string& path);
  /// A scene file that may be read, its paths resolved. Throws Error, those of read_scene() and resolve(); an
  /// upload is given up then.
  SceneDescription read(const std::filesystem::path& path);
  /// Makes paths of a scene that a page has absolute and canonical: names of uploads, else files of the
  /// roots. Paths that `trusted` has as they are stay so. Throws Error, those of Roots::resolve_paths(), and
  /// kFileNotFound where there is no such file.
  void resolve(SceneDescription& scene, const std::set<std::string>& trusted);
  /// The same of a scene that follows `before`, whose paths may be read.
  void resolve_edited(SceneDescription& scene, const SceneDescription& before);

  /// `paths` are about to be opened, in place of those before.
  void begin(std::vector<std::filesystem::path> paths) { opening_ = std::move(paths); }
  /// They could not be: uploads among them are given up.
  void failed();
  /// They, and all that `scene` names, stay.
  void opened(const SceneDescription& scene);
  /// All that `scene` names stays.
  void keep(const SceneDescription& scene);

 private:
  /// Completes paths that are the names of uploads. Of a scene file in `scene_folder` what lies beside it
  /// comes first, of one that a page has (empty) the uploads. Throws Error kFileNotFound where there is
  /// neither.
  void find_uploads(SceneDescription& scene, const std::filesystem::path& scene_folder) const;

  Roots roots_;
  Uploads& uploads_;
  std::vector<std::filesystem::path> opening_;
};

}  // namespace voxlume::server
