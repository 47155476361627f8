#include "server/roots.h"

#include <algorithm>

#include "scene/labels.h"
#include "scene/scene_file.h"
#include "server/header_files.h"
#include "voxlume/error.h"

namespace voxlume::server {

namespace fs = std::filesystem;

Roots::Roots(const fs::path& folder) {
  std::error_code failed;
  const fs::path canonical = fs::canonical(folder, failed);
  if (failed || !fs::is_directory(canonical, failed))
    throw Error(ErrorCode::kFileNotFound, folder.string(), "no such folder");
  roots_.push_back(canonical);
}

void Roots::add(const fs::path& path) {
  std::error_code failed;
  const fs::path canonical = fs::canonical(path, failed);
  if (!failed) roots_.push_back(canonical);
}

bool Roots::contains(const fs::path& canonical) const {
  return std::any_of(roots_.begin(), roots_.end(), [&](const fs::path& root) {
    const auto [end, rest] = std::mismatch(root.begin(), root.end(), canonical.begin(), canonical.end());
    return end == root.end();
  });
}

fs::path Roots::resolve(const std::string& text) const {
  if (text.find('\0') != std::string::npos)
    throw Error(ErrorCode::kBadParameter, "", "a path has no zero bytes");
  std::error_code failed;
  const fs::path path = folder() / text;  // an absolute text takes the folder's place
  const fs::path canonical = fs::weakly_canonical(path, failed);
  if (failed || !contains(canonical))
    throw Error(ErrorCode::kBadParameter, text,
                "is outside the folders that this viewer may read; start it with --folder to open others");
  const fs::file_status status = fs::status(canonical, failed);
  if (!fs::is_regular_file(status) && !fs::is_directory(status))
    throw Error(ErrorCode::kFileNotFound, text, "no such file or folder");
  return canonical;
}

bool Roots::leads_inside(const fs::path& path) const {
  std::error_code failed;
  const fs::path canonical = fs::weakly_canonical(path, failed);
  return !failed && contains(canonical);
}

bool Roots::is_named(const fs::path& canonical) const {
  return std::find(roots_.begin() + 1, roots_.end(), canonical) != roots_.end();
}

fs::path Roots::resolve_to_open(const std::string& text) const {
  const fs::path path = resolve(text);
  if (is_named(path)) return path;
  std::error_code failed;
  if (fs::is_directory(path, failed)) {
    for (const fs::path& link : links_in_folder(path))
      if (!leads_inside(link))
        throw Error(ErrorCode::kBadParameter, text,
                    link.filename().string() + " in it leads to a file outside the folders of this viewer");
    return path;
  }
  for (const std::string& name : files_named_in_header(path))
    if (!leads_inside(path.parent_path() / name))
      throw Error(ErrorCode::kBadParameter, text,
                  "its voxels are in a file outside the folders of this viewer");
  return path;
}

void Roots::check_label_files(const SceneDescription& scene) const {
  const auto check = [&](const std::string& volume, const std::string& where) {
    if (is_named(volume)) return;
    for (const fs::path& file : label_files_beside(volume))
      if (!leads_inside(file))
        throw Error(
            ErrorCode::kBadParameter, where,
            file.filename().string() +
                ", beside it, leads to a file outside the folders of this viewer; name a file of label "
                "names inside them");
  };
  if (scene.labels && scene.labels->names.empty()) check(scene.labels->path, "/labels/path");
  for (std::size_t i = 0; i < scene.proxies.size(); ++i) {
    const ProxyDescription& proxy = scene.proxies[i];
    if (proxy.kind == ProxyKind::kFile && proxy.lookup == Lookup::kNearest)
      check(proxy.path, "/proxies/" + std::to_string(i) + "/path");
  }
}

void Roots::resolve_paths(SceneDescription& scene, const std::set<std::string>& trusted) const {
  for_each_path(scene, [&](std::string& path) {
    if (!trusted.contains(path)) path = resolve_to_open(path).string();
  });
  check_label_files(scene);
}

std::set<std::string> scene_paths(SceneDescription scene) {
  std::set<std::string> paths;
  for_each_path(scene, [&](std::string& path) { paths.insert(path); });
  return paths;
}

}  // namespace voxlume::server
