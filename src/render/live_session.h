#pragma once
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/progress.h"
#include "camera/camera.h"
#include "render/session.h"
#include "voxlume/image.h"
#include "voxlume/renderer.h"
#include "voxlume/scene.h"

namespace voxlume {

/// What most of a frame's time went to. Nothing: the picture is done.
enum class LiveLimit { kTracing, kDenoising, kCompiling, kDeveloping, kNothing };

/// A picture on its way to the screen. Never changed once it is out.
struct LiveFrame {
  std::uint64_t number = 0;    ///< from 1, without gaps
  std::uint64_t revision = 0;  ///< of the newest edit that it shows
  bool moving = false;         ///< drawn for speed, perhaps smaller than asked for
  bool hurried = false;        ///< still, but edits come one after the other; it comes again after the last
  bool done = false;           ///< a stop rule of the scene is reached; the next frame follows an edit
  Image8 picture;  ///< developed, of the size it was traced at; left of the split without denoiser
  std::shared_ptr<const Image> linear;  ///< what was developed, denoised; with metadata where not moving
  /// From the eye to what stands for the pixel [mm], 0 where nothing does; a value a pixel of `picture`.
  std::vector<float> depth_mm;
  CameraView camera{};                                              ///< [LPS mm]
  int width = 0, height = 0;                                        ///< what the scene asks for
  double spp = 0;                                                   ///< samples per pixel of `picture`
  std::optional<double> noise;                                      ///< as in StopRule; absent while moving
  double compile_s = 0, trace_s = 0, denoise_s = 0, develop_s = 0;  ///< spent on this frame
  double frame_s = 0;  ///< from taking the edit, or the frame before, to this one
  LiveLimit limit = LiveLimit::kTracing;
};

/// Whom a LiveSession tells: one call at a time, by threads of its own. All may be empty; they must not
/// throw, wait for the session or destroy it.
struct LiveListener {
  /// A new picture. While this runs nothing is traced, so that what it does counts as the frame's time.
  std::function<void(std::shared_ptr<const LiveFrame>)> frame;
  /// A scene could not be compiled or traced; the picture stays that of the last good one.
  std::function<void(std::uint64_t revision, const std::string& message)> trouble;
  /// A still picture gets better; a few times a second.
  std::function<void(const RenderProgress&)> progress;
  /// What CompiledScene::warnings() says of the scene on screen, each time that it says something else.
  std::function<void(const std::vector<std::string>&)> warnings;
  /// How much of the volume the session has looked over, while it is made; by several threads in turn.
  Progress preparing;
  /// How much of compiling a scene is done, where it takes longer than LiveOptions::patience_s: what is
  /// derived from the volume, and lists of what is important. 1 at its end, also where it was given up.
  Progress compiling;
};

struct LiveOptions {
  int threads = 0;                   ///< 0: all the machine has
  double frame_budget_s = 1.0 / 30;  ///< of a frame while the view moves
  double rest_s = 0.25;              ///< a view without edits for so long is still
  double patience_s = 1;             ///< what takes longer is told of
};

/// A volume on screen: takes edits at any time from any thread and answers with pictures.
///
/// While edits come in, pictures are as large and as good as fits the time of a frame; once they stop the
/// scene is rendered at its full size until its own stop rule, and its film is then the one that
/// render_picture() makes. An edit starts anew only what it touches: a camera keeps the majorants, exposure
/// and denoiser keep the samples. Edits are never refused for being too many: show() returns at once, and of
/// scenes that came while a frame was drawn the last one is next.
class LiveSession {
 public:
  /// Takes the volume's statistics and resolves `scene` (session().description()), but shows nothing yet.
  /// Throws Error, those of resolve().
  LiveSession(const SceneDescription& scene, Volume volume, LiveListener listener, LiveOptions options = {});
  /// Ends what is being rendered within a fraction of a second.
  ~LiveSession();
  LiveSession(const LiveSession&) = delete;
  LiveSession& operator=(const LiveSession&) = delete;

  /// `scene` with everything open chosen from the volume. Throws Error, those of resolve(). Any thread.
  SceneDescription resolved(const SceneDescription& scene) const;
  /// Its volume and description; what is compiled is for the session's own thread alone.
  const Session& session() const { return session_; }

  /// Asks for the picture of `scene`, which is resolved and of this volume, in place of what was asked
  /// before. Returns its revision, which grows by 1 with every call. Any thread; never waits for rendering.
  std::uint64_t show(SceneDescription scene);
  /// The part of the picture from the left that is shown without denoiser; absent: none. [0, 1]
  void set_split(std::optional<double> split);
  /// Nothing is rendered while nobody watches. Watched unless told otherwise.
  void set_watched(bool watched);

  /// While something else needs the processors, a still picture stays as it was first shown, and is not
  /// refined. Off unless told otherwise.
  void set_yielding(bool yielding);

  /// Asks for a small picture of another scene of this volume, `spp` samples without denoiser, as large as
  /// its image says: drawn when the view is still and watched, one after the other, and handed to `done` by
  /// the session's thread; an empty one (0 x 0) where it failed or the session ended.
  void draw_aside(SceneDescription scene, int spp, std::function<void(Image8)> done);

 private:
  class Loop;

  struct Aside {
    SceneDescription scene;
    int spp;
    std::function<void(Image8)> done;
  };
  /// What other threads ask for, under mutex_.
  struct Wishes {
    std::optional<SceneDescription> scene;
    std::uint64_t revision = 0;
    std::optional<double> split;
    bool split_changed = false, watched = true, yielding = false, ending = false;
    std::vector<Aside> asides;
  };

  Session session_;
  const LiveListener listener_;
  const LiveOptions options_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  Wishes wishes_;
  std::atomic<bool> cancel_{false};  ///< the pass at work is out of date
  std::atomic<bool> ending_{false};  ///< and all else
  std::thread thread_;
};

}  // namespace voxlume
