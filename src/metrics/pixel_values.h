#pragma once
#include "voxlume/image.h"

namespace voxlume {

/// Which values of a linear picture a measure takes.
enum class PixelValues {
  kLinear,   ///< as they are [radiance]
  kDisplay,  ///< the sRGB encoding of the linear values clamped to [0,1], what a display shows at EV 0; in
             ///< [0,1]
};

/// The value that a measure takes of a linear one.
double pixel_value(float linear, PixelValues values);

/// Throws Error kBadParameter when the picture is empty, or an R, G or B value is not finite. `which` is how
/// the message calls it: "the picture".
void check_picture(const Image& image, const char* which);

/// Throws Error kBadParameter unless the picture is `width` x `height` pixels large.
void check_size(const Image& image, int width, int height);

/// Throws Error kBadParameter when the sizes differ, or as check_picture for either.
void check_pair(const Image& image, const Image& reference);

}  // namespace voxlume
