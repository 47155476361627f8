#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "denoise/denoiser.h"
#include "voxlume/image.h"

namespace voxlume {

/// Takes noise out of pictures of one view, one after the other, as a Denoiser does with frames.
class FileDenoiser {
 public:
  /// Throws Error kUnsupported when the method's library is not installed.
  explicit FileDenoiser(const DenoiserKind& kind);

  /// The next picture without noise and without layers, transparent where the given one is. It keeps the
  /// metadata but for "voxlume:digest", which stands for a frame as it was rendered, and gets
  /// "voxlume:denoiser". `where` names the picture in messages. Throws Error: those of frame_from_image.
  Image denoise(const Image& picture, const std::string& where);

 private:
  const DenoiserKind& kind_;
  std::unique_ptr<Denoiser> denoiser_;
  DenoisedFrame denoised_;
};

/// Writes a picture as EXR or, developed as the scene in its metadata says, as PNG, by the extension of
/// `path`. Without a scene the default exposure and tone curve are taken. `where` names the picture's source.
/// Throws Error: kBadFormat for a scene that makes no sense, and those of save_picture.
void save_with_own_scene(const Image& picture, const std::string& where, const std::filesystem::path& path);

}  // namespace voxlume
