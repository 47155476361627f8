#pragma once
#include "denoise/denoiser.h"

namespace voxlume {

/// Spatiotemporal variance-guided filtering (schied2017): colours and their moments are averaged over time,
/// and five levels of the a-trous filter tolerate differences in luminance by the variance that was found.
/// The first level's colours are what the next frame continues.
///
/// What is adapted to volumes: colours are premultiplied and weigh as much as there is matter; alpha has its
/// own filter; the guides are noisy (Guides::feature_rate) and include the albedo, as colours cannot be
/// divided by it where light scatters many times.
std::unique_ptr<Denoiser> make_svgf();

/// A-SVGF (schied2018): SVGF that forgets where samples shaded again show that the light has changed. Without
/// frame.gradients it is SVGF.
std::unique_ptr<Denoiser> make_asvgf();

}  // namespace voxlume
