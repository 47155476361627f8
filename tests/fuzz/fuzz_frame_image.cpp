#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "render/frame_image.h"
#include "voxlume/error.h"

// Any text is a camera and a size or one Error, and a frame that is read has finite numbers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t line = text.find('\n');
  voxlume::Image image(2, 1);
  image.metadata["voxlume:camera"] = text.substr(0, line);
  image.metadata["voxlume:size_mm"] = line == std::string_view::npos ? "1" : text.substr(line + 1);
  voxlume::DenoiseFrame empty = voxlume::make_denoise_frame(2, 1);
  const std::string size_text = image.metadata["voxlume:size_mm"];
  voxlume::add_denoise_layers(empty, image);
  image.metadata["voxlume:size_mm"] = size_text;
  try {
    const voxlume::DenoiseFrame frame = voxlume::frame_from_image(image, {}, "picture.exr");
    if (!std::isfinite(frame.size_mm) || !std::isfinite(frame.camera.eye_mm.x)) std::abort();
  } catch (const voxlume::Error& error) {
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) std::abort();
  }
  return 0;
}
