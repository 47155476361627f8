#include "base/atomic_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <fstream>

#include "voxlume/error.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;

// Unique among the threads of this process and the processes of this machine.
fs::path temporary_beside(const fs::path& path) {
  static std::atomic<unsigned> serial{0};
  return path.parent_path() / fmt::format(".{}.{}-{}.tmp", path.filename().string(), ::getpid(), serial++);
}

// What `path` names in the end; a link that leads nowhere names the file it would make.
fs::path follow_links(fs::path path) {
  std::error_code failed;
  for (int depth = 0; depth < 40 && fs::is_symlink(path, failed); ++depth) {
    const fs::path target = fs::read_symlink(path, failed);
    if (failed) break;
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  return path;
}

}  // namespace

void write_file_atomically(const fs::path& path,
                           const std::function<void(const fs::path& temporary)>& write) {
  const fs::path target = follow_links(path);
  std::error_code failed;
  const fs::file_status status = fs::status(target, failed);
  if (fs::is_directory(status)) {
    throw Error(ErrorCode::kBadParameter, path.string(), "is a folder; expected a file name");
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    write(target);
    return;
  }
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, failed)) {
    throw Error(ErrorCode::kFileNotFound, path.string(), "the folder " + folder.string() + " does not exist");
  }
  const fs::path temporary = temporary_beside(target);
  try {
    write(temporary);
    if (fs::exists(status)) fs::permissions(temporary, status.permissions(), failed);
    fs::rename(temporary, target, failed);
    if (failed) throw Error(ErrorCode::kInternal, path.string(), "cannot be replaced: " + failed.message());
  } catch (...) {
    fs::remove(temporary, failed);
    throw;
  }
}

void write_file_atomically(const fs::path& path, std::string_view bytes) {
  write_file_atomically(path, [&](const fs::path& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) {
      throw Error(ErrorCode::kInternal, path.string(), "cannot be written (disk full or no permission?)");
    }
  });
}

}  // namespace voxlume
