#include "server/temporary_folder.h"

#include <stdlib.h>

#include <cerrno>
#include <cstring>

#include "base/fail.h"

namespace voxlume::server {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
  std::string name = (fs::temp_directory_path() / "voxlume-view-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    fail(ErrorCode::kInternal, name, std::string("cannot be made: ") + std::strerror(errno));
  path_ = fs::canonical(name);
}

void TemporaryFolder::remove() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace voxlume::server
