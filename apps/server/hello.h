#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "server/roots.h"
#include "voxlume/scene.h"

namespace voxlume::server {

/// Something to open that comes with the program.
struct Sample {
  std::string name, path, summary;
};

/// The samples that are in `folder`, scenes in examples/ beside it, and the phantom.
std::vector<Sample> find_samples(const std::filesystem::path& folder);

/// What a page needs to know before anything else: names to choose from.
nlohmann::json hello_message(const std::vector<Sample>& samples, const std::filesystem::path& environments,
                             const Roots& roots);

/// The scene that a volume is opened with in the viewer: the default picture, denoised.
SceneDescription default_view_scene();

}  // namespace voxlume::server
