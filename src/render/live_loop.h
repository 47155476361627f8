#pragma once
#include <chrono>
#include <optional>

#include "render/frame_size.h"
#include "render/live_session.h"
#include "render/picture.h"

namespace voxlume {

/// What the thread of a LiveSession does: takes the last scene asked for, and draws it.
class LiveSession::Loop {
 public:
  explicit Loop(LiveSession& live) : live_(live), sizes_(live.options_.frame_budget_s) {}

  /// Until the session ends.
  void run();

 private:
  using Clock = std::chrono::steady_clock;

  /// What the next step is.
  enum class Step { kEnd, kMove, kRefine, kAside };
  /// Whether the picture has been shown as it is now: not at all, in a hurry, or as well as it is.
  enum class Shown { kNot, kQuickly, kWell };

  Step wait();
  void take_wishes();
  void take_scene(SceneDescription scene);
  bool at_rest() const;
  Clock::duration rest() const;
  template <class Work>
  void attempt(Work&& work);

  void move();
  void refine();
  Aside next_aside();
  void draw(Aside aside);
  void give_up_asides();

  FilmLayers layers() const;
  void compile_still();
  StopRule still_stop() const;
  bool still_done() const;
  int next_still_spp() const;
  RenderStatus trace(RenderState& state, const StopRule& stop, const std::atomic<bool>* cancel,
                     bool tells) const;
  RenderProgress overall(const RenderProgress& pass) const;
  void publish(const RenderState& state, Shown how);
  std::shared_ptr<const Image> picture(const RenderState& state, Shown how);
  Image8 develop(const RenderState& state, const Image& linear) const;

  LiveSession& live_;
  std::optional<SceneDescription> scene_;  ///< the last taken
  std::uint64_t revision_ = 0;
  std::optional<double> split_;
  bool failed_ = false;  ///< scene_ cannot be drawn
  bool done_ = false;    ///< a stop rule of scene_ is reached
  Shown shown_ = Shown::kNot;
  std::optional<RenderState> moving_, still_;
  bool still_compiled_ = false;  ///< what is compiled is scene_ at its full size
  std::shared_ptr<const Image> denoised_;  ///< of still_ as it is, or null
  std::optional<PictureDenoiser> denoiser_;
  std::string denoiser_name_;
  bool forgets_ = true;  ///< the denoiser's history is of other matter
  FrameSizeChoice sizes_;
  Clock::time_point edited_{}, framed_{};  ///< when the last wish was taken; the last frame or such a wish
  LiveFrame spent_;                        ///< seconds spent on the frame at work
  double show_s_ = 0;                      ///< what publishing took last
  std::uint64_t frames_ = 0;
  std::uint32_t drawn_ = 0;  ///< moving frames, whose random numbers differ
};

}  // namespace voxlume
