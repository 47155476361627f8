#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "grid/volume_statistics.h"
#include "scene/resolve.h"
#include "scene/scene_file.h"
#include "server/document.h"
#include "server/messages.h"
#include "voxlume/error.h"

namespace {

using namespace voxlume;

/// A document of a volume of two voxels.
struct Fixture {
  Fixture() {
    static const std::uint8_t kVoxels[] = {0, 255};
    volume.size = {2, 1, 1};
    volume.voxels = std::shared_ptr<const void>(kVoxels, [](const void*) {});
    statistics = compute_statistics(make_grid_view(volume));
  }
  server::Document document() const {
    SceneDescription scene;
    scene.volume.path = "two.nrrd";
    const auto resolved = [this](const SceneDescription& s) { return resolve(s, volume, statistics); };
    return server::Document(resolved(scene), {.resolve = resolved, .check_paths = [](auto&, const auto&) {}});
  }
  Volume volume;
  VolumeStatistics statistics;
};

}  // namespace

// Any bytes are a message or one Error; any edit leaves a document that is the scene it says, and can be
// undone.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Fixture fixture;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  server::seq_of(text);
  try {
    const server::PageMessage message = server::parse_message(text);
    const auto* edit = std::get_if<server::EditMessage>(&message);
    if (edit == nullptr) return 0;
    server::Document document = fixture.document();
    const nlohmann::json before = document.json();
    document.edit(edit->set, edit->gesture);
    if (!(parse_scene(document.json().dump(), "scene") == document.scene())) std::abort();
    const auto sizeless = [](nlohmann::json scene) {
      scene["image"].erase("width");
      scene["image"].erase("height");
      return scene;
    };
    if (document.undo() && sizeless(document.json()) != sizeless(before)) std::abort();
  } catch (const Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
