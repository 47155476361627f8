#include "cli/picture.h"

#include <fmt/format.h>

#include <cstring>

#include "cli/output_file.h"
#include "image_io/image_io.h"
#include "render/film_image.h"
#include "scene/scene_file.h"
#include "tonemap/tone_map.h"

namespace voxlume::cli {
namespace {

namespace fs = std::filesystem;

/// The scene for a picture's metadata. File names often hold names of patients, so it has none.
std::string anonymous_scene(SceneDescription scene) {
  for_each_path(scene, [](std::string& path) { path = "not-recorded"; });
  return write_scene(scene);
}

/// FNV-1a.
class Digest {
 public:
  template <class T>
  void add(const T& value) {
    static_assert(std::is_arithmetic_v<T>);
    unsigned char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (const unsigned char byte : bytes) state_ = (state_ ^ byte) * 0x100000001b3ull;
  }
  std::uint64_t state() const { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ull;
};

std::uint64_t volume_digest(const Volume& volume, const VolumeStatistics& statistics) {
  Digest digest;
  digest.add(static_cast<int>(volume.type));
  for (const auto n : volume.size) digest.add(n);
  for (const double x : volume.spacing_mm) digest.add(x);
  for (const double x : volume.origin_mm) digest.add(x);
  for (const double x : volume.direction) digest.add(x);
  digest.add(statistics.gradient_p999);
  for (const auto& [value, count] : statistics.histogram) {
    digest.add(value);
    digest.add(count);
  }
  return digest.state();
}

}  // namespace

void write_picture(const Film& film, const std::vector<std::string>& aovs, const SceneDescription& scene,
                   const fs::path& path) {
  const bool transparent = scene.background && scene.background->kind == BackgroundKind::kTransparent;
  Image image = image_from_film(film, aovs, transparent);
  image.metadata["voxlume:scene"] = anonymous_scene(scene);
  image.metadata["voxlume:seed"] = std::to_string(scene.render.seed);
  image.metadata["voxlume:version"] = VOXLUME_VERSION;
  if (picture_format(path, "-o") == PictureFormat::kExr) {
    write_exr(image, path);
    return;
  }
  write_png(tone_map(image, {.exposure_ev = scene.image.exposure_ev,
                             .curve = scene.image.tone_curve,
                             .transparent = transparent,
                             .dither = false}),
            path);
}

std::string scene_fingerprint(const SceneDescription& scene, const Volume& volume,
                              const VolumeStatistics& statistics) {
  SceneDescription samples = scene;
  const ImageDescription defaults;
  samples.image.spp = defaults.spp;
  samples.image.seconds = defaults.seconds;
  samples.image.noise = defaults.noise;
  samples.image.exposure_ev = defaults.exposure_ev;
  samples.image.tone_curve = defaults.tone_curve;
  samples.volume = {};  // its digest stands for it, wherever it lies
  for_each_path(samples, [](std::string& path) { path = fs::absolute(path).lexically_normal().string(); });
  return fmt::format("voxlume {}\n{:016x}\n{}", VOXLUME_VERSION, volume_digest(volume, statistics),
                     write_scene(samples));
}

}  // namespace voxlume::cli
