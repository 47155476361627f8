#pragma once
#include <optional>

#include "metrics/pixel_values.h"
#include "voxlume/image.h"

namespace voxlume {

// How far a picture is from a reference. All compare R, G and B (premultiplied, as they are) and leave alpha
// and layers alone. Display values are those of PixelValues::kDisplay.
// Each throws Error kBadParameter when the sizes differ, a picture is empty, or a value is not finite.

/// Root of the mean squared difference of the values.
double rmse(const Image& image, const Image& reference, PixelValues values = PixelValues::kLinear);

/// 10 log10(1 / mean squared difference of the display values) [dB]; absent when they are identical.
std::optional<double> psnr(const Image& image, const Image& reference);

/// 10 log10(peak^2 / mean squared difference of the linear values) [dB], where peak is the 99.9 % quantile
/// (nearest rank) of the reference's values; absent when the pictures are identical or the peak is not
/// positive.
std::optional<double> psnr_hdr(const Image& image, const Image& reference);

/// Structural similarity (Wang et al. 2004) of the display values' luma, in [-1,1]: Gaussian window of 11 x
/// 11 with sigma 1.5, K1 = 0.01, K2 = 0.03, L = 1, mean over the windows that lie inside the picture. Absent
/// when the picture is smaller than a window.
std::optional<double> ssim(const Image& image, const Image& reference);

}  // namespace voxlume
