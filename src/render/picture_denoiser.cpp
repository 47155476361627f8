#include "render/picture_denoiser.h"

#include "render/denoise_frame.h"
#include "scene/resolve.h"

namespace voxlume {

FilmLayers denoiser_layers(const std::string& name) {
  if (name == "none") return {};
  const DenoiserNeeds& needs = find_denoiser(name).needs;
  // Classes hold the light from matter apart, which all methods start from.
  return {.normal = needs.normal, .albedo = needs.albedo, .classes = true};
}

PictureDenoiser::PictureDenoiser(const std::string& name)
    : kind_(find_denoiser(name)), denoiser_(kind_.make()) {}

void PictureDenoiser::apply(const Film& film, const CompiledScene& scene, Image& image) {
  const auto size_mm = static_cast<float>(visible_sphere(scene.volume(), std::nullopt).radius_mm);
  fill_denoise_frame(film, scene.view(), size_mm, frame_);
  if (kind_.needs.gradients) gradients_.fill(scene.view(), film, frame_);
  denoiser_->denoise(frame_, denoised_);
  const bool transparent = scene.view().background == BackgroundKind::kTransparent;
  image.rgba = compose_picture(frame_, denoised_, transparent).rgba;
}

void PictureDenoiser::forget() {
  denoiser_->forget();
  gradients_.forget();
}

}  // namespace voxlume
