#pragma once
#include <string>

#include "denoise/denoiser.h"
#include "denoise/frame.h"
#include "voxlume/image.h"

namespace voxlume {

/// The word of ImageDescription::aovs that stands for every layer below.
constexpr const char* kDenoiseAov = "denoise";

/// Adds all layers that a frame has (the table in voxlume/image.h) and its size as "voxlume:size_mm". Layers
/// that the picture has already are kept. The picture has the frame's size.
void add_denoise_layers(const DenoiseFrame& frame, Image& image);

/// The frame that a picture holds, for a method with these needs; what others would need as well is left out
/// (classes) or zero. Values that are not finite or beyond 1e16, or negative where none can be, and
/// classes of more samples than the pixel has make the pixel empty.
///
/// A picture with the layer "matter" or a camera is voxlume's and has to have every layer that the needs
/// name. In pictures of other programs everything is matter: radiance and alpha are R, G, B and A, and of the
/// layers "depth" (or a channel Z), "normal", "albedo", "samples" and "variance" only normal and albedo are
/// required, where they are needed. Without a camera the view stands still.
///
/// Throws Error kBadFormat at `where` for a layer or channel that is missing, and for a camera or size that
/// makes no sense.
DenoiseFrame frame_from_image(const Image& image, const DenoiserNeeds& needs, const std::string& where);

}  // namespace voxlume
