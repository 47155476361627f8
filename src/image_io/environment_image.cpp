#include <algorithm>
#include <cmath>
#include <string>

#include "image_io/image_io.h"
#include "voxlume/error.h"

namespace voxlume {

EnvironmentImage read_environment(const std::filesystem::path& path, const ImageReadOptions& options) {
  const Image image = read_image(path, options);
  if (image.width != 2 * image.height) {
    throw Error(ErrorCode::kBadFormat, path.string(),
                "is " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                    "; an environment is twice as wide as high");
  }
  EnvironmentImage environment{image.width, image.height, {}};
  environment.rgb.reserve(image.pixel_count() * 3);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float value = image.rgba[4 * i + c];
      if (!std::isfinite(value)) {
        throw Error(ErrorCode::kBadFormat, path.string(),
                    "has the value " + std::to_string(value) + " at pixel " +
                        std::to_string(i % image.width) + "," + std::to_string(i / image.width) +
                        "; expected finite radiance");
      }
      environment.rgb.push_back(std::max(value, 0.0f));
    }
  }
  return environment;
}

}  // namespace voxlume
