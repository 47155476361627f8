#pragma once
#include <atomic>
#include <functional>
#include <optional>
#include <vector>

#include "render/frame_files.h"
#include "render/session.h"
#include "voxlume/renderer.h"

namespace voxlume {

/// Where a sequence is.
struct SequenceProgress {
  int position = 1, count = 1;        ///< the frame at hand is the position-th of count
  RenderProgress picture;             ///< of that frame
  std::optional<double> s_per_frame;  ///< mean over the frames rendered since the start
  std::optional<double> remaining_s;  ///< estimate for all frames that are left
};

struct SequenceOptions {
  FramePattern files;
  FrameRange range;
  bool resume = false;  ///< keep frames that are there; else the caller has seen to it that there are none
  int threads = 0;      ///< 0: all the machine has
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const SequenceProgress&)> progress;
  /// Called with every frame written; load_s is the time it took to compile.
  std::function<void(int frame, const RenderStatistics&)> written;
};

/// The frames of the range that are still to be rendered. Every frame's scene is made and checked on the way,
/// so that an animation that cannot be rendered to its end is refused at its beginning.
/// Throws Error kBadParameter: what frame_description throws; a frame that is there and belongs to another
/// scene or to other settings.
std::vector<int> frames_to_render(const Session& session, const SequenceOptions& options);

/// Renders `frames` in their order, each as a still of its own scene (Session::frame_description) would be,
/// and writes them; what was rendered of a frame when the caller cancels stays in its checkpoint, from where
/// it goes on if `resume` is set. Throws Error: those of render_picture and save_picture.
RenderStatus render_sequence(Session& session, const std::vector<int>& frames,
                             const SequenceOptions& options);

}  // namespace voxlume
