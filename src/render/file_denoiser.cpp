#include "render/file_denoiser.h"

#include "render/denoise_frame.h"
#include "render/frame_image.h"
#include "render/picture.h"
#include "scene/scene_file.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

constexpr const char* kSceneText = "voxlume:scene";

bool is_transparent(const Image& picture) {
  for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
    if (picture.rgba[4 * i + 3] < 1) return true;
  }
  return false;
}

}  // namespace

FileDenoiser::FileDenoiser(const DenoiserKind& kind) : kind_(kind), denoiser_(kind.make()) {}

Image FileDenoiser::denoise(const Image& picture, const std::string& where) {
  const DenoiseFrame frame = frame_from_image(picture, kind_.needs, where);
  denoiser_->denoise(frame, denoised_);
  Image out = compose_picture(frame, denoised_, is_transparent(picture));
  out.metadata = picture.metadata;
  out.metadata.erase("voxlume:digest");
  out.metadata["voxlume:denoiser"] = kind_.name;
  return out;
}

void save_with_own_scene(const Image& picture, const std::string& where, const std::filesystem::path& path) {
  SceneDescription scene;
  const auto text = picture.metadata.find(kSceneText);
  if (!is_exr_name(path) && text != picture.metadata.end()) {
    try {
      scene = parse_scene(text->second, kSceneText);
    } catch (const Error& error) {
      throw Error(ErrorCode::kBadFormat, where, "its scene cannot be read: " + std::string(error.what()));
    }
  } else if (is_transparent(picture)) {
    scene.background = BackgroundDescription{.kind = BackgroundKind::kTransparent};
  }
  save_picture(picture, scene, path);
}

}  // namespace voxlume
