#include "server/scene_files.h"

#include "scene/scene_file.h"
#include "voxlume/error.h"

namespace voxlume::server {

namespace fs = std::filesystem;

fs::path SceneFiles::to_open(const std::string& path) {
  const fs::path file = uploads_.opened_as(roots_.resolve(path));
  try {
    return roots_.resolve_to_open(file.string());
  } catch (const Error&) {
    uploads_.give_up(file);
    throw;
  }
}

SceneDescription SceneFiles::read(const fs::path& path) {
  try {
    SceneDescription scene = read_scene(path);
    find_uploads(scene, path.parent_path());
    roots_.resolve_paths(scene);
    return scene;
  } catch (const Error&) {
    uploads_.give_up(path);
    throw;
  }
}

void SceneFiles::resolve(SceneDescription& scene, const std::set<std::string>& trusted) {
  find_uploads(scene, {});
  roots_.resolve_paths(scene, trusted);
}

void SceneFiles::resolve_edited(SceneDescription& scene, const SceneDescription& before) {
  const std::set<std::string> trusted = scene_paths(before);
  for_each_path(scene, [&](std::string& path) {
    if (!trusted.contains(path)) path = to_open(path).string();
  });
  roots_.check_label_files(scene);
}

void SceneFiles::failed() {
  for (const fs::path& path : opening_) uploads_.give_up(path);
}

void SceneFiles::opened(const SceneDescription& scene) {
  for (const fs::path& path : opening_) uploads_.keep(path);
  keep(scene);
}

void SceneFiles::keep(const SceneDescription& scene) {
  for (const std::string& path : scene_paths(scene)) uploads_.keep(path);
}

void SceneFiles::find_uploads(SceneDescription& scene, const fs::path& scene_folder) const {
  const bool is_file = !scene_folder.empty();
  for_each_path(scene, [&](std::string& path) {
    const fs::path given = fs::path(path).lexically_normal();
    if (is_file ? given.parent_path() != scene_folder : given.has_parent_path()) return;
    const fs::path place = is_file ? given : roots_.folder() / given;
    const fs::path uploaded = uploads_.find(given.filename().string());
    std::error_code failed;
    const bool there = fs::exists(fs::symlink_status(place, failed));
    if (there && (is_file || uploaded.empty())) return;
    if (uploaded.empty())
      throw Error(ErrorCode::kFileNotFound, given.filename().string(),
                  "no such file beside the scene; drop it on the page first, then load the scene again");
    path = uploaded.string();
  });
}

}  // namespace voxlume::server
