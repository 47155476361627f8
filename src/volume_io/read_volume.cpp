#include <fmt/format.h>

#include <cmath>

#include "base/fail.h"
#include "volume_io/isolated_read.h"
#include "volume_io/raw_read.h"
#include "voxlume/volume_io.h"

namespace voxlume {

namespace {

Volume read(const std::filesystem::path& path, const ReadOptions& options) {
  if (!options.raw) return read_isolated(path, options);
  try {
    Volume volume = read_raw(path, *options.raw, options.memory_limit_bytes, options.progress);
    if (options.spacing_mm) volume.spacing_mm = *options.spacing_mm;
    return volume;
  } catch (const std::filesystem::filesystem_error& failure) {
    fail(ErrorCode::kFileNotFound, path, "cannot be read: " + failure.code().message());
  }
}

}  // namespace

Volume read_volume(const std::filesystem::path& path, const ReadOptions& options) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    fail(ErrorCode::kFileNotFound, path,
         error ? "cannot be reached: " + error.message() : "no such file or folder");
  }
  if (options.spacing_mm) {
    for (const double s : *options.spacing_mm) {
      if (!(std::isfinite(s) && s > 0)) {
        fail(ErrorCode::kBadParameter, path,
             fmt::format("spacing {}; expected finite numbers above 0 (mm)", s));
      }
    }
  }
  if (!options.progress) return read(path, options);
  double told = 0;  // a reader that is started again begins anew
  ReadOptions growing = options;
  growing.progress = [&](double share) {
    if (share > told && share < 1) options.progress(told = share);
  };
  Volume volume = read(path, growing);
  options.progress(1);
  return volume;
}

}  // namespace voxlume
