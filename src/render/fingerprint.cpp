#include "render/fingerprint.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <string_view>
#include <type_traits>

#include "scene/scene_file.h"

namespace voxlume {
namespace {

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
  void add_text(std::string_view text) {
    for (const char c : text) add(c);
  }
  std::string text() const { return fmt::format("{:016x}", state_); }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ull;
};

/// The scene with absolute paths and without the volume's: its digest stands for it, wherever it lies.
std::string scene_text(SceneDescription scene) {
  scene.volume = {};
  for_each_path(
      scene, [](std::string& path) { path = std::filesystem::absolute(path).lexically_normal().string(); });
  return write_scene(scene);
}

}  // namespace

std::string volume_digest(const Volume& volume, const VolumeStatistics& statistics) {
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
  return digest.text();
}

SceneDescription scene_of_samples(SceneDescription scene) {
  const ImageDescription defaults;
  scene.image.spp = defaults.spp;
  scene.image.seconds = defaults.seconds;
  scene.image.noise = defaults.noise;
  scene.image.exposure_ev = defaults.exposure_ev;
  scene.image.tone_curve = defaults.tone_curve;
  return scene;
}

std::string scene_fingerprint(const SceneDescription& scene, const std::string& volume_digest) {
  return fmt::format("voxlume {}\n{}\n{}", VOXLUME_VERSION, volume_digest,
                     scene_text(scene_of_samples(scene)));
}

std::string picture_digest(const SceneDescription& scene, const std::string& volume_digest) {
  Digest digest;
  digest.add_text(VOXLUME_VERSION);
  digest.add_text(volume_digest);
  digest.add_text(scene_text(scene));
  return digest.text();
}

}  // namespace voxlume
