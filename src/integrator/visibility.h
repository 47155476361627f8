#pragma once
#include <vector>

#include "base/progress.h"
#include "integrator/scene_view.h"
#include "sampling/rng.h"

namespace voxlume {

/// How lists are refined.
struct ListRefinement {
  int samples = 48;  ///< a pass
  int passes = 16;   ///< every fourth of even strata, the others where they find out most
};

/// Finds the importance along the ray of a pixel's centre; `seed` and `pixel` choose the random numbers.
/// Fills `segments`; entry and exit are mm from the ray's origin. A ray that misses, or on which nothing can
/// be important, has no segments.
SegmentListView find_importance(const SceneView& scene, int x, int y, const ListRefinement& refinement,
                                std::vector<ImportanceSegment>& segments);

/// Takes how much of the lists is done, as Progress does: about ten times a second. What it throws ends them.
using ListProgress = Progress;

/// The list of every pixel, in one pool. Owns what view() points to.
class PixelLists {
 public:
  /// `scene` has its camera, medium, clip box and importance. `progress` may be empty.
  PixelLists(const SceneView& scene, const ListRefinement& refinement, const ListProgress& progress = {});
  PixelListsView view() const { return {heads_.data(), pool_.data()}; }

  std::size_t bytes() const {
    return heads_.size() * sizeof(PixelListsView::Head) + pool_.size() * sizeof(ImportanceSegment);
  }
  /// What building them took.
  double seconds() const { return seconds_; }

 private:
  double seconds_ = 0;
  std::vector<PixelListsView::Head> heads_;
  std::vector<ImportanceSegment> pool_;
};

/// The list of the pixel that an image point is in.
SegmentListView list_at(const SceneView& scene, float px, float py) noexcept;

/// Finds the importance along the line of a light ray, from one sample in each of the scene's strata.
/// Distances of the list are from the light's end of the ray's part in the volume, t -> ray.t_far - t: so q
/// weighs what stands between the light and the important, as for the eye. The line goes on behind the ray's
/// origin: what scatters is often the very surface of what is important, with nothing of it on the way to the
/// light.
SegmentListView find_light_importance(const SceneView& scene, const TrackRay& ray, const Rng& stream,
                                      std::vector<ImportanceSegment>& segments);

}  // namespace voxlume
