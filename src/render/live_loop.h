#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

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
  /// All that any denoiser needs, so that another one needs no new samples.
  static constexpr FilmLayers kLayers{.depth = true, .normal = true, .albedo = true, .classes = true};
  /// As many samples make the standard error known; the render loop looks at it from there on, too.
  static constexpr int kNoiseFrom = 8;

  /// What the next step is.
  enum class Step { kEnd, kMove, kRefine, kAside };
  /// Whether the picture has been shown as it is now: not at all, in a hurry, or as well as it is.
  enum class Shown { kNot, kQuickly, kWell };

  Step wait();
  void take_wishes();
  void note_edit();
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

  void compile(SceneDescription scene, bool gives_way);
  void compile_still();
  void begin_still();
  StopRule still_stop() const;
  bool still_done() const;
  bool still_is_best() const;
  int next_still_spp() const;
  RenderStatus trace(RenderState& state, const StopRule& stop, const std::atomic<bool>* cancel,
                     bool tells) const;
  RenderProgress overall(const RenderProgress& pass) const;

  // From samples to the screen (live_publish.cpp).
  void publish(const RenderState& state, Shown how);
  void show_again();
  std::shared_ptr<const Image> picture(const RenderState& state);
  Image8 develop(const RenderState& state, const Image& linear) const;
  void hand_out(std::shared_ptr<LiveFrame> frame, Shown how);

  static double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }
  /// Calls `work` and gives the seconds it took.
  template <class Work>
  static double seconds_of(Work&& work) {
    const Clock::time_point begin = Clock::now();
    work();
    return seconds(Clock::now() - begin);
  }

  LiveSession& live_;
  std::optional<SceneDescription> scene_;  ///< the last taken
  std::uint64_t revision_ = 0;
  std::optional<double> split_;
  bool failed_ = false;  ///< scene_ cannot be drawn
  bool done_ = false;    ///< a stop rule of scene_ is reached
  Shown shown_ = Shown::kNot;
  bool hurried_ = false;  ///< the last wish came before the one before it was at rest
  std::optional<RenderState> moving_, still_;
  std::shared_ptr<const LiveFrame>
      on_screen_;                          ///< the picture of moving_, until one of still_ takes its place
  std::vector<std::string> warnings_;      ///< told last
  int first_still_spp_ = 0;                ///< from which on it does
  bool still_compiled_ = false;            ///< what is compiled is scene_ at its full size
  std::shared_ptr<const Image> denoised_;  ///< of still_ as it is, or null
  std::optional<RenderState> spare_;       ///< what was still_, for its memory
  std::optional<PictureDenoiser> moving_denoiser_, still_denoiser_;
  std::string denoiser_name_;
  bool forgets_ = true;  ///< the history of moving_denoiser_ is of other matter
  int history_ = 0;      ///< frames in it, of that size
  std::pair<int, int> history_size_{};
  FrameSizeChoice sizes_;
  Clock::time_point edited_{}, framed_{};  ///< when the last wish was taken; the last frame or such a wish
  LiveFrame spent_;                        ///< seconds spent on the frame at work
  double show_s_ = 0;                      ///< what publishing took last
  std::uint64_t frames_ = 0;
  std::uint32_t drawn_ = 0;  ///< moving frames, whose random numbers differ
};

}  // namespace voxlume
