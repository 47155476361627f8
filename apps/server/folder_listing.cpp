#include "server/folder_listing.h"

#include <algorithm>
#include <tuple>

#include "base/file_extension.h"
#include "volume_io/file_format.h"
#include "voxlume/error.h"

namespace voxlume::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// A DICOM folder may hold tens of thousands.
constexpr std::size_t kMostEntries = 5000;

const char* kind_of(const fs::path& path, bool folder) {
  if (folder) return "folder";
  const std::string extension = lower_extension(path);
  if (extension == ".json") return "scene";
  if (extension == ".exr" || extension == ".hdr") return "environment";
  return format_of_extension(path) ? "volume" : "other";
}

}  // namespace

json folder_listing(const Roots& roots, const std::string& path) {
  const fs::path folder = roots.resolve(path);
  const fs::path relative = folder.lexically_relative(roots.folder());
  if (relative.empty() || *relative.begin() == "..")
    throw Error(ErrorCode::kBadParameter, path,
                "leads out of the folder of this viewer; start it with --folder to list others");
  std::error_code failed;
  if (!fs::is_directory(folder, failed)) throw Error(ErrorCode::kFileNotFound, path, "is no folder");
  struct Entry {
    bool file;
    std::string name;
    std::uintmax_t bytes;
  };
  std::vector<Entry> entries;
  for (auto it = fs::directory_iterator(folder, failed);
       !failed && it != fs::directory_iterator() && entries.size() < kMostEntries; it.increment(failed)) {
    const std::string name = it->path().filename().string();
    if (name.starts_with('.')) continue;
    try {
      const fs::path resolved = roots.resolve(it->path().string());
      const bool file = !fs::is_directory(resolved);
      entries.push_back({file, name, file ? fs::file_size(resolved) : 0});
    } catch (const std::exception&) {
      continue;  // leads outside, or went away
    }
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return std::tie(a.file, a.name) < std::tie(b.file, b.name);
  });
  const fs::path shown = relative == "." ? fs::path() : relative;
  json list = json::array();
  for (const Entry& entry : entries)
    list.push_back({{"name", entry.name},
                    {"path", (shown / entry.name).generic_string()},
                    {"kind", kind_of(entry.name, !entry.file)},
                    {"bytes", entry.bytes}});
  return {{"path", shown.generic_string()}, {"entries", list}};
}

}  // namespace voxlume::server
