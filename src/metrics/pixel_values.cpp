#include "metrics/pixel_values.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "tonemap/srgb.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

}  // namespace

double pixel_value(float linear, PixelValues values) {
  return values == PixelValues::kLinear ? linear : srgb_from_linear(std::clamp(linear, 0.0f, 1.0f));
}

void check_picture(const Image& image, const char* which) {
  if (image.width < 1 || image.height < 1) {
    throw Error(ErrorCode::kBadParameter, "",
                std::string(which) + " is empty (" + size_text(image.width, image.height) +
                    "); expected at least one pixel");
  }
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    for (int c = 0; c < 3; ++c) {
      if (std::isfinite(image.rgba[4 * i + c])) continue;
      throw Error(ErrorCode::kBadParameter, "",
                  std::string(which) + " has a value that is not finite at pixel " +
                      std::to_string(i % image.width) + "," + std::to_string(i / image.width) +
                      "; expected finite values");
    }
  }
}

void check_size(const Image& image, int width, int height) {
  if (image.width == width && image.height == height) return;
  throw Error(ErrorCode::kBadParameter, "",
              "sizes differ: " + size_text(image.width, image.height) + " and " + size_text(width, height) +
                  "; expected equal sizes");
}

void check_pair(const Image& image, const Image& reference) {
  check_size(image, reference.width, reference.height);
  check_picture(image, "the picture");
  check_picture(reference, "the reference");
}

}  // namespace voxlume
