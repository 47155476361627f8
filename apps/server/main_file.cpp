#include "server/main_file.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/file_extension.h"
#include "scene/scene_file.h"
#include "server/header_files.h"
#include "volume_io/file_format.h"
#include "voxlume/error.h"

namespace voxlume::server {

namespace fs = std::filesystem;

namespace {

/// "a.nrrd, b.nrrd and 7 more".
std::string listed(const std::vector<fs::path>& files) {
  constexpr std::size_t kMostListed = 3;
  std::string out;
  for (std::size_t i = 0; i < std::min(files.size(), kMostListed); ++i)
    out += (i > 0 ? ", " : "") + files[i].filename().string();
  return files.size() > kMostListed ? out + " and " + std::to_string(files.size() - kMostListed) + " more"
                                    : out;
}

/// Other programs write .json beside their volumes, too, of any size.
bool is_scene(const fs::path& file) {
  std::error_code failed;
  if (lower_extension(file) != ".json" || fs::file_size(file, failed) > kMaxSceneBytes || failed)
    return false;
  std::ifstream stream(file);
  constexpr bool kThrows = false;
  const auto json = nlohmann::json::parse(stream, nullptr, kThrows);
  return json.is_object() && json.contains("volume");
}

/// Says which file is missing rather than that it cannot be read.
void check_voxels_are_there(const fs::path& header) {
  for (const std::string& name : files_named_in_header(header)) {
    const bool is_pattern = name.find('%') != std::string::npos;
    std::error_code failed;
    if (!is_pattern && !fs::exists(header.parent_path() / name, failed))
      throw Error(ErrorCode::kFileNotFound, header.filename().string(),
                  "its voxels are in " + name + ": send both files together");
  }
}

}  // namespace

fs::path main_file(const fs::path& path) {
  if (!fs::is_directory(path)) {
    check_voxels_are_there(path);
    return path;
  }
  std::vector<fs::path> scenes, volumes, tiffs, dicoms;
  for (const auto& entry : fs::directory_iterator(path)) {
    const fs::path& file = entry.path();
    const auto format = format_of_extension(file);
    if (is_scene(file)) scenes.push_back(file);
    if (!format) continue;
    (format == FileFormat::kTiff ? tiffs : format == FileFormat::kDicom ? dicoms : volumes).push_back(file);
  }
  for (auto* files : {&scenes, &volumes, &tiffs, &dicoms}) std::sort(files->begin(), files->end());
  if (scenes.size() == 1) return scenes.front();  // the others are what it names
  std::vector<fs::path> first = scenes;
  for (const auto* files : {&volumes, &tiffs, &dicoms})
    if (!files->empty()) first.push_back(files->front());
  const bool mixed = first.size() > 1 || volumes.size() > 1;
  if (mixed)
    throw Error(ErrorCode::kUnsupported, path.filename().string(),
                "expected one volume, or the slices of one; found " +
                    listed(volumes.size() > 1 ? volumes : first) + ": open one at a time");
  if (volumes.empty()) return path;
  check_voxels_are_there(volumes.front());
  return volumes.front();
}

}  // namespace voxlume::server
