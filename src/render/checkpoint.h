#pragma once
#include <filesystem>
#include <string>

#include "render/render_loop.h"

namespace voxlume {

/// Where the checkpoint of a picture lies: beside it, with ".checkpoint" appended to its name.
std::filesystem::path checkpoint_path(const std::filesystem::path& output);

/// Saves a render so that it can go on later, bit for bit. `fingerprint` stands for everything the samples
/// depend on (scene, seed, size). Written aside and renamed. Throws Error kFileNotFound, kInternal.
void save_checkpoint(const RenderState& state, const std::string& fingerprint,
                     const std::filesystem::path& path);

/// Loads what save_checkpoint wrote. Throws Error: kFileNotFound; kBadFormat when the file is damaged, is no
/// checkpoint or has another format version; kBadParameter when it belongs to another scene; kOutOfMemory.
RenderState load_checkpoint(const std::filesystem::path& path, const std::string& fingerprint);

}  // namespace voxlume
