#pragma once
#include <span>
#include <string>
#include <vector>

#include "base/progress.h"
#include "grid/volume_statistics.h"
#include "transfer/classifier.h"
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume {

/// The voxels of a proxy: read, or derived from `from`, which the proxy's `of` names. Throws Error with the
/// field of the proxy at `where` ("/proxies/0"), those of open_volume and of deriving. `progress` may be
/// empty.
Volume proxy_volume(const ProxyDescription& proxy, const Volume& from, const std::string& where,
                    const Progress& progress = {});

/// The main volume and a scene's proxies, read or derived, as rules name them.
class RuleVolumes {
 public:
  /// Positions of the views are LPS mm from origin_mm. `main` has these statistics and must outlive this.
  /// Throws Error with the JSON path of a wrong proxy (a name twice or reserved, nothing to read or to derive
  /// from), kBadFormat for labels that are no whole numbers, and those of read_volume and of deriving.
  /// `progress` may be empty; what it throws ends this.
  RuleVolumes(const Volume& main, const VolumeStatistics& statistics,
              const std::vector<ProxyDescription>& proxies, const Double3& origin_mm,
              const Progress& progress = {});
  RuleVolumes(RuleVolumes&&) = default;
  RuleVolumes& operator=(RuleVolumes&&) = default;

  /// "data" first.
  std::span<const RuleVolume> volumes() const { return volumes_; }
  /// What reading the files had to say.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void add(const ProxyDescription& proxy, Volume volume, const Double3& origin_mm, const std::string& where,
           const Progress& progress);

  std::vector<Volume> voxels_;                    ///< of the proxies, which the views point to
  std::vector<std::vector<std::uint8_t>> leads_;  ///< of labels with a smooth outline
  std::vector<RuleVolume> volumes_;
  std::vector<std::string> warnings_;
};

}  // namespace voxlume
