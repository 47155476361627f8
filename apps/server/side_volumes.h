#pragma once
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "grid/volume_statistics.h"
#include "scene/labels.h"
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume::server {

/// A volume that a scene has beside its main one.
struct SideVolume {
  Volume volume;
  VolumeStatistics statistics;
  bool labels = false;              ///< looked up by the nearest voxel
  std::vector<float> label_values;  ///< those that occur, ascending; empty where it has none
  LabelTable table;                 ///< of labels
};

/// Proxies and labels of scenes, each read or derived when it is first asked for and kept while scenes go on
/// having it. Any thread; what takes long makes others wait.
class SideVolumes {
 public:
  /// `main` is the volume that proxies are derived from.
  explicit SideVolumes(Volume main) : main_(std::move(main)) {}

  /// The proxy called `name`, or "labels" for the scene's own. Throws Error kFileNotFound where the scene has
  /// none of that name, and those of reading and deriving.
  std::shared_ptr<const SideVolume> find(const SceneDescription& scene, const std::string& name);

 private:
  /// All that decides what a side volume is.
  struct Origin {
    std::vector<ProxyDescription> proxies;  ///< itself, what it is derived from, and so on; labels as a file
    std::string names;                      ///< of labels: the file with their names
    friend bool operator==(const Origin&, const Origin&) = default;
  };
  struct Kept {
    Origin origin;
    std::shared_ptr<const SideVolume> volume;
  };
  std::shared_ptr<const SideVolume> keep(const Origin& origin, const Volume& from, const std::string& where);

  const Volume main_;
  std::mutex mutex_;
  std::list<Kept> kept_;  ///< the one used last in front
};

/// Names of the scene's label volumes: proxies with nearest look-up, and "labels".
std::vector<std::string> label_volume_names(const SceneDescription& scene);

/// What is called `value` in a table; empty where it has no name.
std::string label_name(const LabelTable& table, double value);

}  // namespace voxlume::server
