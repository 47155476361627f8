#include "render/picture.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/file_extension.h"
#include "image_io/image_io.h"
#include "integrator/path_tracer.h"
#include "render/camera_text.h"
#include "render/checkpoint.h"
#include "render/denoise_frame.h"
#include "render/film_image.h"
#include "render/frame_image.h"
#include "scene/resolve.h"
#include "scene/scene_file.h"
#include "tonemap/tone_map.h"

namespace voxlume {
namespace {

/// The scene for a picture's metadata. File names often hold names of patients, so it has none.
std::string anonymous_scene(SceneDescription scene) {
  for_each_path(scene, [](std::string& path) { path = "not-recorded"; });
  return write_scene(scene);
}

bool is_transparent(const SceneDescription& scene) {
  return scene.background && scene.background->kind == BackgroundKind::kTransparent;
}

}  // namespace

PictureSamples render_picture(const CompiledScene& scene, const std::string& fingerprint,
                              const PictureOptions& options) {
  const ImageDescription& image = scene.description().image;
  FilmLayers layers = film_layers(options.aovs);
  const FilmLayers for_denoiser = denoiser_layers(scene.description().render.denoise);
  layers.normal |= for_denoiser.normal;
  layers.albedo |= for_denoiser.albedo;
  layers.classes |= for_denoiser.classes;
  PictureSamples out{options.resume && std::filesystem::exists(options.checkpoint)
                         ? load_checkpoint(options.checkpoint, fingerprint)
                         : RenderState{Film(image.width, image.height, layers), {}, 0}};
  RenderLoopOptions loop;
  loop.stop = {image.spp, image.seconds, image.noise};
  if (layers.classes) loop.first_run = kClassifiedTogether;
  loop.threads = options.threads;
  loop.cancel = options.cancel;
  loop.checkpoint = options.checkpoint;
  loop.fingerprint = fingerprint;
  loop.progress = options.progress;
  SceneView view = scene.view();
  view.keeps_parts = out.state.film.layers().classes;
  const auto trace = [&](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
    render_tile(view, tile, begin, end, film, counters);
  };
  out.status = run_render_loop(out.state, trace, loop).status;
  return out;
}

Image finish_picture(const RenderState& state, const CompiledScene& scene,
                     const std::vector<std::string>& aovs, const std::optional<FrameStamp>& frame,
                     PictureDenoiser* denoiser) {
  const SceneDescription& description = scene.description();
  Image image = image_from_film(state.film, aovs, is_transparent(description));
  if (std::find(aovs.begin(), aovs.end(), kDenoiseAov) != aovs.end()) {
    DenoiseFrame layers;
    const double size_mm = visible_sphere(scene.volume(), std::nullopt).radius_mm;
    fill_denoise_frame(state.film, scene.view(), static_cast<float>(size_mm), layers);
    add_denoise_layers(layers, image);
  }
  if (denoiser != nullptr) {
    denoiser->apply(state.film, scene, image);
    image.metadata["voxlume:denoiser"] = description.render.denoise;
  }
  describe_picture(scene, frame, image);
  return image;
}

void describe_picture(const CompiledScene& scene, const std::optional<FrameStamp>& frame, Image& image) {
  const SceneDescription& description = scene.description();
  image.metadata["voxlume:scene"] = anonymous_scene(description);
  image.metadata["voxlume:seed"] = std::to_string(description.render.seed);
  image.metadata["voxlume:version"] = VOXLUME_VERSION;
  image.metadata["voxlume:camera"] = write_camera(scene.view().camera, scene.origin_mm());
  if (frame) {
    image.metadata["voxlume:frame"] = std::to_string(frame->number);
    image.metadata["voxlume:time_s"] = nlohmann::json(frame->time_s).dump();
  }
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
