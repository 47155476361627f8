#include "scene/open_volume.h"

#include <sstream>

#include "base/vec.h"
#include "grid/phantom.h"
#include "scene/scene_file.h"
#include "voxlume/error.h"
#include "voxlume/volume_io.h"

namespace voxlume {
namespace {

void check_orthonormal(const std::array<double, 9>& direction) {
  const auto column = [&](int a) { return Vec3d(direction[a], direction[3 + a], direction[6 + a]); };
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      if (!(std::abs(dot(column(a), column(b)) - (a == b ? 1.0 : 0.0)) < 1e-4)) {
        throw Error(ErrorCode::kBadParameter, "/volume/direction",
                    "expected orthonormal columns; columns " + std::to_string(a) + " and " +
                        std::to_string(b) + " are not");
      }
    }
  }
}

std::string number_text(double x) {
  std::ostringstream text;
  text << x;
  return text.str();
}

Volume read(const VolumeDescription& description, const Progress& progress) {
  if (description.path == kPhantomPath) {
    Volume phantom = make_head_phantom();
    if (description.spacing_mm) phantom.spacing_mm = *description.spacing_mm;
    return phantom;
  }
  ReadOptions options;
  if (!description.raw.empty()) options.raw = parse_raw_spec(description.raw);
  options.spacing_mm = description.spacing_mm;
  options.progress = progress;
  return read_volume(description.path, options);
}

}  // namespace

Volume open_volume(const VolumeDescription& description, const Progress& progress) {
  if (description.path.empty()) {
    throw Error(ErrorCode::kBadParameter, "/volume", "missing key \"path\": the scene names no volume");
  }
  if (description.direction) check_orthonormal(*description.direction);
  Volume volume = read(description, progress);
  if (description.origin_mm) volume.origin_mm = *description.origin_mm;
  if (description.direction) volume.direction = *description.direction;
  for (const double spacing : volume.spacing_mm) {
    if (spacing < 1e-6 || spacing > 1e6)
      throw Error(
          ErrorCode::kBadParameter, description.path,
          "a voxel spacing of " + number_text(spacing) +
              " mm; expected 1e-6 to 1e6: give --spacing in millimetres (or a larger unit of your own)");
  }
  return volume;
}

}  // namespace voxlume
