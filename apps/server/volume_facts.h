#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "grid/volume_statistics.h"
#include "server/side_volumes.h"
#include "voxlume/volume.h"

namespace voxlume::server {

/// {"lo", "hi", "counts": [512]} of the finite values.
nlohmann::json histogram_json(const VolumeStatistics& statistics);

/// What a page shows of a volume (/api/volume).
nlohmann::json volume_json(const std::string& name, const Volume& volume, const VolumeStatistics& statistics);

/// [{"value", "name", "color"}] of the labels that occur; 0 is background.
nlohmann::json labels_json(const SideVolume& labels);

}  // namespace voxlume::server
