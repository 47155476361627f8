// Measures a live session: frames per second while the camera turns with an edit every 1/60 s, and how long
// an edit takes from its call to the frame that shows it, of the camera and of the transfer function, from a
// picture that stands still and while edits go on. Wall time, medians and 95th percentiles. Prints JSON.
// Usage: voxlume_live_speed VOLUME [DENOISER [SECONDS [EDGE]]], the volume stretched to EDGE^3 voxels
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "measure.h"
#include "render/live_session.h"
#include "stretched.h"
#include "voxlume/error.h"

namespace {

using namespace voxlume;
using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

double seconds(Clock::duration d) { return std::chrono::duration<double>(d).count(); }

double percentile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1,
                         static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

/// A session that remembers when each frame came.
class Watched {
 public:
  Watched(const SceneDescription& scene, const Volume& volume)
      : live_(scene, volume,
              {[this](std::shared_ptr<const LiveFrame> frame) { hear(std::move(frame)); }, {}, {}, {}}),
        scene_(live_.session().description()) {}

  /// Shows the scene after `change`.
  template <class Change>
  std::uint64_t edit(Change&& change) {
    change(scene_);
    const Clock::time_point now = Clock::now();
    const std::lock_guard lock(mutex_);
    const std::uint64_t revision = live_.show(live_.resolved(scene_));
    edited_.push_back(now);
    return revision;
  }
  /// Until a frame shows that revision, or a later one.
  void wait(std::uint64_t revision) {
    std::unique_lock lock(mutex_);
    shown_.wait(lock, [&] { return newest_ >= revision; });
  }

  struct Seen {
    std::shared_ptr<const LiveFrame> frame;
    Clock::time_point at;
    double latency_s;  ///< since its revision was asked for
    bool first;        ///< of its revision
  };
  std::vector<Seen> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(seen_, {});
  }

 private:
  void hear(std::shared_ptr<const LiveFrame> frame) {
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    const std::uint64_t revision = frame->revision;
    seen_.push_back({std::move(frame), now, seconds(now - edited_[revision - 1]), revision > newest_});
    newest_ = std::max(newest_, revision);
    shown_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable shown_;
  std::vector<Clock::time_point> edited_;
  std::vector<Seen> seen_;
  std::uint64_t newest_ = 0;
  LiveSession live_;
  SceneDescription scene_;
};

Json latencies(const std::vector<Watched::Seen>& seen) {
  std::vector<double> ms;
  for (const auto& s : seen)
    if (s.first) ms.push_back(1e3 * s.latency_s);
  return {{"median_ms", percentile(ms, 0.5)}, {"p95_ms", percentile(ms, 0.95)}, {"edits", ms.size()}};
}

/// Edits at 60 Hz for so long.
template <class Change>
Json drag(Watched& watched, double length_s, Change&& change) {
  watched.take();
  const Clock::time_point begin = Clock::now();
  int edits = 0;
  while (seconds(Clock::now() - begin) < length_s) {
    watched.edit([&](SceneDescription& scene) { change(scene, edits); });
    std::this_thread::sleep_until(begin + std::chrono::microseconds(16667) * ++edits);
  }
  std::vector<Watched::Seen> seen = watched.take();
  std::erase_if(seen, [](const auto& s) { return !s.frame->moving; });
  std::vector<double> frame, compile, trace, denoise, develop;
  for (std::size_t i = 1; i < seen.size(); ++i) {
    frame.push_back(1e3 * seconds(seen[i].at - seen[i - 1].at));
    compile.push_back(1e3 * seen[i].frame->compile_s);
    trace.push_back(1e3 * seen[i].frame->trace_s);
    denoise.push_back(1e3 * seen[i].frame->denoise_s);
    develop.push_back(1e3 * seen[i].frame->develop_s);
  }
  const LiveFrame& last = *seen.back().frame;
  return {{"fps", 1e3 * static_cast<double>(frame.size()) /
                      std::max(1.0, seconds(seen.back().at - seen[0].at) * 1e3)},
          {"frame_p95_ms", percentile(frame, 0.95)},
          {"compile_ms", percentile(compile, 0.5)},
          {"trace_ms", percentile(trace, 0.5)},
          {"denoise_ms", percentile(denoise, 0.5)},
          {"develop_ms", percentile(develop, 0.5)},
          {"internal", {last.picture.width, last.picture.height}},
          {"spp", last.spp},
          {"latency", latencies(seen)}};
}

/// What showing a picture that stands still takes.
Json stills(const std::vector<Watched::Seen>& seen) {
  std::vector<double> denoise, develop;
  for (const auto& s : seen) {
    if (s.frame->moving) continue;
    denoise.push_back(1e3 * s.frame->denoise_s);
    develop.push_back(1e3 * s.frame->develop_s);
  }
  return {{"denoise_ms", percentile(denoise, 0.5)},
          {"develop_ms", percentile(develop, 0.5)},
          {"frames", denoise.size()}};
}

/// Single edits of a picture that stands still.
template <class Change>
Json clicks(Watched& watched, Change&& change) {
  watched.take();
  for (int i = 0; i < 20; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    watched.wait(watched.edit([&](SceneDescription& scene) { change(scene, i); }));
  }
  const std::vector<Watched::Seen> seen = watched.take();
  Json out = latencies(seen);
  out["still"] = stills(seen);
  return out;
}

void turn(SceneDescription& scene, int i) { scene.camera.azimuth_deg = 2.0 * i; }
void fade(SceneDescription& scene, int i) {
  for (TransferPoint& point : scene.transfer.points) point.value += i % 2 ? 5 : -5;
}

Json measure(const Volume& volume, const std::string& denoiser, int width, int height, double length_s) {
  SceneDescription scene;
  scene.render.denoise = denoiser;
  scene.image.width = width;
  scene.image.height = height;
  const Clock::time_point begin = Clock::now();
  Watched watched(scene, volume);
  watched.wait(watched.edit([](SceneDescription&) {}));
  Json out{{"size", {width, height}}, {"first_picture_s", seconds(Clock::now() - begin)}};
  drag(watched, 1, turn);
  out["orbit"] = drag(watched, length_s, turn);
  out["transfer_drag"] = drag(watched, length_s, fade);
  out["camera_click"] = clicks(watched, turn);
  out["transfer_click"] = clicks(watched, fade);
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 5) {
    std::fprintf(stderr, "usage: voxlume_live_speed VOLUME [DENOISER [SECONDS [EDGE]]]\n");
    return 2;
  }
  try {
    VolumeDescription description;
    description.path = argv[1];
    Volume volume = open_volume(description);
    if (argc > 4) volume = stretched(volume, std::max(2, std::atoi(argv[4])));
    const std::string denoiser = argc > 2 ? argv[2] : "decoupled";
    const double length_s = argc > 3 ? std::atof(argv[3]) : 5;
    Json out{{"volume_voxels", volume.size}, {"denoiser", denoiser}, {"sizes", Json::array()}};
    out["sizes"].push_back(measure(volume, denoiser, 640, 360, length_s));
    out["sizes"].push_back(measure(volume, denoiser, 1280, 720, length_s));
    std::printf("%s\n", out.dump(2).c_str());
  } catch (const Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
