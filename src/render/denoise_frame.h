#pragma once
#include "denoise/frame.h"
#include "film/film.h"
#include "integrator/scene_view.h"
#include "voxlume/image.h"

namespace voxlume {

/// The frame on a film that keeps classes, for denoisers; normals and albedos are zero where the film lacks
/// them. `size_mm` as in DenoiseFrame. Planes of `frame` are made anew only when their size changes; its
/// gradients are not touched.
void fill_denoise_frame(const Film& film, const SceneView& scene, float size_mm, DenoiseFrame& frame);

/// The picture: matter over what is behind it, or premultiplied by alpha over nothing where `transparent`.
Image compose_picture(const DenoiseFrame& frame, const DenoisedFrame& denoised, bool transparent);

}  // namespace voxlume
