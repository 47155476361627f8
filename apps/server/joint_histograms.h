#pragma once
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "grid/volume_statistics.h"
#include "server/side_volumes.h"
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume::server {

/// Joint histograms of the open volume ("data") and those that scenes have beside it, as pages get them. Each
/// is counted when it is first asked for; the last few are kept. Any thread; what takes long makes others
/// wait.
class JointHistograms {
 public:
  /// `main` is the open volume, of these statistics.
  JointHistograms(Volume main, const VolumeStatistics& statistics);

  /// {"x": {"lo", "hi"}, "y": {"lo", "hi"}, "columns", "rows", "counts": [rows of columns]}. Throws Error,
  /// those of SideVolumes::find().
  std::shared_ptr<const std::string> find(SideVolumes& sides, const SceneDescription& scene,
                                          const std::string& x, const std::string& y);

 private:
  using Side = std::shared_ptr<const SideVolume>;  ///< null: the open volume
  struct Kept {
    Side x, y;
    std::shared_ptr<const std::string> json;
  };
  const Volume main_;
  const float lower_, upper_;  ///< of its values
  std::mutex mutex_;
  std::list<Kept> kept_;  ///< the one used last in front
};

}  // namespace voxlume::server
