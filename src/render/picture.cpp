#include "render/picture.h"

#include <nlohmann/json.hpp>

#include "base/file_extension.h"
#include "image_io/image_io.h"
#include "integrator/path_tracer.h"
#include "render/checkpoint.h"
#include "render/film_image.h"
#include "scene/scene_file.h"
#include "tonemap/tone_map.h"

namespace voxlume {
namespace {

/// The scene for a picture's metadata. File names often hold names of patients, so it has none.
std::string anonymous_scene(SceneDescription scene) {
  for_each_path(scene, [](std::string& path) { path = "not-recorded"; });
  return write_scene(scene);
}

nlohmann::json vector_json(Vec3f v) { return {double{v.x}, double{v.y}, double{v.z}}; }

/// The camera that rendered, in the volume's own space.
std::string camera_json(const CameraView& camera, const Double3& origin_mm) {
  const auto point = [&](Vec3f p) {
    return nlohmann::json{origin_mm[0] + p.x, origin_mm[1] + p.y, origin_mm[2] + p.z};
  };
  return nlohmann::ordered_json{{"eye_mm", point(camera.eye_mm)},
                                {"target_mm", point(camera.target_mm)},
                                {"right", vector_json(camera.right)},
                                {"up", vector_json(camera.up)},
                                {"forward", vector_json(camera.forward)},
                                {"half_width", double{camera.half_width}},
                                {"half_height", double{camera.half_height}},
                                {"orthographic", camera.orthographic},
                                {"width_px", static_cast<int>(camera.width_px)},
                                {"height_px", static_cast<int>(camera.height_px)}}
      .dump();
}

bool is_transparent(const SceneDescription& scene) {
  return scene.background && scene.background->kind == BackgroundKind::kTransparent;
}

}  // namespace

PictureSamples render_picture(const CompiledScene& scene, const std::string& fingerprint,
                              const PictureOptions& options) {
  const ImageDescription& image = scene.description().image;
  PictureSamples out{options.resume && std::filesystem::exists(options.checkpoint)
                         ? load_checkpoint(options.checkpoint, fingerprint)
                         : RenderState{Film(image.width, image.height, film_layers(options.aovs)), {}, 0}};
  RenderLoopOptions loop;
  loop.stop = {image.spp, image.seconds, image.noise};
  loop.threads = options.threads;
  loop.cancel = options.cancel;
  loop.checkpoint = options.checkpoint;
  loop.fingerprint = fingerprint;
  loop.progress = options.progress;
  const auto trace = [&](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
    render_tile(scene.view(), tile, begin, end, film, counters);
  };
  out.status = run_render_loop(out.state, trace, loop).status;
  return out;
}

Image finish_picture(const RenderState& state, const CompiledScene& scene,
                     const std::vector<std::string>& aovs, const std::optional<FrameStamp>& frame) {
  const SceneDescription& description = scene.description();
  Image image = image_from_film(state.film, aovs, is_transparent(description));
  image.metadata["voxlume:scene"] = anonymous_scene(description);
  image.metadata["voxlume:seed"] = std::to_string(description.render.seed);
  image.metadata["voxlume:version"] = VOXLUME_VERSION;
  image.metadata["voxlume:camera"] = camera_json(scene.view().camera, scene.origin_mm());
  if (frame) {
    image.metadata["voxlume:frame"] = std::to_string(frame->number);
    image.metadata["voxlume:time_s"] = nlohmann::json(frame->time_s).dump();
  }
  return image;
}

bool is_exr_name(const std::filesystem::path& path) { return lower_extension(path) == ".exr"; }

void save_picture(const Image& picture, const SceneDescription& scene, const std::filesystem::path& path) {
  if (is_exr_name(path)) {
    write_exr(picture, path);
    return;
  }
  write_png(tone_map(picture, {.exposure_ev = scene.image.exposure_ev,
                               .curve = scene.image.tone_curve,
                               .transparent = is_transparent(scene),
                               .dither = false}),
            path);
}

}  // namespace voxlume
