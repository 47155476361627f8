#include "server/hello.h"

#include <algorithm>

#include "base/file_extension.h"
#include "denoise/denoiser.h"
#include "image_io/movie.h"
#include "scene/material_library.h"
#include "scene/presets.h"
#include "scene/scene_file.h"
#include "server/hex_text.h"
#include "voxlume/error.h"

namespace voxlume::server {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

struct KnownSample {
  const char* file;  // relative to the folder of the sample volumes
  const char* name;
  const char* summary;
};
constexpr KnownSample kKnownSamples[] = {
    {"head-ct.nrrd", "Head, CT", "A head: bone, skin and soft tissue in Hounsfield units"},
    {"mri-head.nii.gz", "Head, MRI", "T1-weighted MRI of a head"},
    {"mri-brain.nii.gz", "Brain, MRI", "T1-weighted MRI of a brain without its skull"},
    {"simulated-pet.nrrd", "Brain, simulated PET", "Activity in the brain of the MRI, on its own grid"},
    {"../examples/brain-regions.json", "Brain regions",
     "A scene: 116 regions of the AAL atlas, each its material"},
    {"../examples/brodmann-areas.json", "Brodmann areas", "A scene: areas of the cortex, each its material"},
};

json materials() {
  json out = json::array();
  for (const LibraryMaterial& material : material_library())
    out.push_back({{"name", material.description.name},
                   {"summary", material.summary},
                   {"color", hex_text(material.description.color.value_or(Color{}))}});
  return out;
}

/// Those that pages may read: no link of the folder tells what it leads to elsewhere.
void add_environments(const fs::path& folder, const Roots& roots, json& out) {
  std::error_code failed;
  std::vector<fs::path> paths;
  for (auto it = fs::directory_iterator(folder, failed); !failed && it != fs::directory_iterator();
       it.increment(failed)) {
    const std::string extension = lower_extension(it->path());
    if (extension == ".exr" || extension == ".hdr") paths.push_back(it->path());
  }
  std::sort(paths.begin(), paths.end());
  for (const fs::path& path : paths) {
    try {
      out.push_back({{"name", path.stem().string()}, {"path", roots.resolve(path.string()).string()}});
    } catch (const Error&) {
      continue;  // leads outside, or nowhere
    }
  }
}

bool has_ffmpeg() {
  try {
    find_ffmpeg();
    return true;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

std::vector<Sample> find_samples(const fs::path& folder) {
  std::vector<Sample> out;
  for (const KnownSample& sample : kKnownSamples) {
    std::error_code failed;
    const fs::path path = fs::canonical(folder / sample.file, failed);
    if (!folder.empty() && !failed) out.push_back({sample.name, path.string(), sample.summary});
  }
  out.push_back({"Phantom", std::string(kPhantomPath), "A head built from ellipsoids, without any file"});
  return out;
}

json hello_message(const std::vector<Sample>& samples, const fs::path& environments, const Roots& roots) {
  json out{{"type", "hello"},
           {"version", VOXLUME_VERSION},
           {"folder", roots.folder().filename().string()},
           {"movies", has_ffmpeg()}};
  out["presets"] = json::array();
  for (const Preset& preset : presets())
    out["presets"].push_back({{"name", preset.name}, {"summary", preset.summary}});
  out["materials"] = materials();
  out["denoisers"] = json::array();
  for (const DenoiserKind& kind : denoiser_kinds())
    out["denoisers"].push_back({{"name", kind.name}, {"summary", kind.summary}});
  out["environments"] = json::array();
  if (!environments.empty()) add_environments(environments, roots, out["environments"]);
  if (roots.folder() != environments) add_environments(roots.folder(), roots, out["environments"]);
  out["samples"] = json::array();
  for (const Sample& sample : samples)
    out["samples"].push_back({{"name", sample.name}, {"path", sample.path}, {"summary", sample.summary}});
  return out;
}

SceneDescription default_view_scene() {
  SceneDescription scene;
  scene.render.denoise = denoiser_kinds().front().name;
  return scene;
}

}  // namespace voxlume::server
