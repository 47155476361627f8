#pragma once
#include <nlohmann/json.hpp>
#include <optional>

#include "base/vec.h"
#include "render/live_session.h"
#include "server/side_volumes.h"
#include "voxlume/scene.h"

namespace voxlume::server {

/// What a picture shows at (x, y), from its top left in [0, 1]: the place of the matter that stands for the
/// pixel [LPS mm]. Empty where there is none.
std::optional<Vec3d> place_in_picture(const LiveFrame& frame, double x, double y);

/// Whether the volume has data at a place.
bool is_inside(const Volume& volume, Vec3d p_world);

/// The data at a place: {"position_mm", "voxel", "value"}. The voxel is the nearest one; the value is
/// interpolated, null where it is not finite.
nlohmann::json data_at(const Volume& volume, Vec3d p_world);

/// [{"of", "value", "name"}] of the scene's label volumes at a place that is in them. One that cannot be read
/// is left out.
nlohmann::json labels_at(const SceneDescription& scene, SideVolumes& sides, Vec3d p_world);

}  // namespace voxlume::server
