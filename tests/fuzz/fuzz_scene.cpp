#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "scene/scene_file.h"
#include "voxlume/error.h"

// Any bytes are a valid scene or one Error, and a valid scene survives being written and read again.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const voxlume::SceneDescription scene = voxlume::parse_scene(text, "scene.json");
    if (!(voxlume::parse_scene(voxlume::write_scene(scene), "written") == scene)) std::abort();
  } catch (const voxlume::Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
