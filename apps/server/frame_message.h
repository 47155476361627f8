#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "render/live_session.h"

namespace voxlume::server {

/// A frame as viewers get it, coded once for all.
struct FrameMessage {
  std::uint64_t number = 0;                  ///< as viewers know it
  std::shared_ptr<const LiveFrame> frame;    ///< what it shows
  std::shared_ptr<const std::string> bytes;  ///< the binary message
};

/// Numbers that frames of a session have for viewers, to whom numbers of a later session go on.
struct FrameNumbering {
  std::uint64_t frames_before = 0, revisions_before = 0;
};

/// Codes the frames of one session.
class FrameCoder {
 public:
  /// Throws Error kInternal.
  FrameMessage code(std::shared_ptr<const LiveFrame> frame, const FrameNumbering& numbering);

 private:
  double mean_frame_s_ = 0;  ///< of those while the view moves, the last few weighing most
};

}  // namespace voxlume::server
