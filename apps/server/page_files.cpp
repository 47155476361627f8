#include "server/page_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>

#include "base/file_extension.h"

namespace voxlume::server {

namespace fs = std::filesystem;

namespace {

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' || c == '_' ||
         c == '-' || c == '/';
}

std::string content_type(const fs::path& path) {
  static const std::map<std::string, std::string> kTypes{{".html", "text/html; charset=utf-8"},
                                                         {".js", "text/javascript; charset=utf-8"},
                                                         {".css", "text/css; charset=utf-8"},
                                                         {".svg", "image/svg+xml"},
                                                         {".png", "image/png"},
                                                         {".jpg", "image/jpeg"},
                                                         {".ico", "image/x-icon"},
                                                         {".json", "application/json"},
                                                         {".map", "application/json"},
                                                         {".txt", "text/plain; charset=utf-8"},
                                                         {".wasm", "application/wasm"},
                                                         {".webmanifest", "application/manifest+json"},
                                                         {".woff2", "font/woff2"}};
  const auto found = kTypes.find(lower_extension(path));
  return found == kTypes.end() ? "application/octet-stream" : found->second;
}

}  // namespace

fs::path PageFiles::find(const fs::path& program) {
  if (const char* chosen = std::getenv("VOXLUME_PAGE"); chosen != nullptr && *chosen != '\0') return chosen;
  for (const char* place : {"../web", "../share/voxlume/web"}) {
    const fs::path folder = (program.parent_path() / place).lexically_normal();
    std::error_code ignored;
    if (fs::is_regular_file(folder / "index.html", ignored)) return folder;
  }
  return {};
}

bool PageFiles::exists() const {
  std::error_code ignored;
  return !folder_.empty() && fs::is_regular_file(folder_ / "index.html", ignored);
}

std::optional<PageFile> PageFiles::file(std::string_view request_path) const {
  if (folder_.empty() || !request_path.starts_with('/')) return std::nullopt;
  if (!std::all_of(request_path.begin(), request_path.end(), is_plain)) return std::nullopt;
  const std::string name(request_path == "/" ? "index.html" : request_path.substr(1));
  std::error_code failed;
  const fs::path root = fs::canonical(folder_, failed);
  if (failed) return std::nullopt;
  const fs::path path = fs::canonical(root / name, failed);
  if (failed || !fs::is_regular_file(path, failed)) return std::nullopt;
  const auto [end, rest] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  if (end != root.end()) return std::nullopt;
  const auto changed = fs::last_write_time(path, failed).time_since_epoch().count();
  const auto size = fs::file_size(path, failed);
  if (failed) return std::nullopt;
  return PageFile{path, content_type(path), fmt::format("\"{:x}-{:x}\"", size, changed)};
}

}  // namespace voxlume::server
