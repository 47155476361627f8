#include <fmt/format.h>

#include <algorithm>

#include "metrics/temporal.h"
#include "study.h"

namespace voxlume::study {
namespace {

/// Frames at one number of samples: those before a moment, the moment with several seeds, and frames after
/// it in which nothing moves any more.
struct Frames {
  std::vector<DenoiseFrame> before, at, after;
  double render_ms = 0;  ///< mean of one of `after`
};

Frames render_frames(const Options& o, Sequence& sequence, int moment, int spp) {
  Frames frames;
  for (int f = std::max(moment - o.history, 0); f < moment; ++f) {
    sequence.go_to(f);
    sequence.render(spp, static_cast<std::uint32_t>(f), frames.before.emplace_back());
  }
  sequence.go_to(moment);
  for (int i = 0; i < o.seeds; ++i)
    sequence.render(spp, static_cast<std::uint32_t>(10000 + i), frames.at.emplace_back());
  for (int i = 0; i < o.rest; ++i)
    frames.render_ms +=
        sequence.render(spp, static_cast<std::uint32_t>(20000 + i), frames.after.emplace_back()) / o.rest;
  return frames;
}

void replay(Method& method, const Frames& frames) {
  method.forget();
  if (!method.has_history()) return;
  for (const DenoiseFrame& frame : frames.before) method.denoise(frame);
}

/// The histories are played anew for each seed: denoisers cannot be copied.
double variance(Method& method, const Frames& frames) {
  TemporalVariance variance;
  for (const DenoiseFrame& frame : frames.at) {
    replay(method, frames);
    method.denoise(frame);
    variance.add(method.picture(frame));
  }
  return variance.sum();
}

std::string convergence(Method& method, const Frames& frames) {
  replay(method, frames);
  method.denoise(frames.at.front());
  ConvergenceTime time;
  time.add(method.picture(frames.at.front()), 0);
  double seconds = 0, denoise_ms = 0;
  for (const DenoiseFrame& frame : frames.after) {
    denoise_ms = method.denoise(frame);
    seconds += (frames.render_ms + denoise_ms) / 1000;
    time.add(method.picture(frame), seconds);
  }
  const auto moment = [](const std::optional<ConvergenceTime::Moment>& m) {
    return m ? fmt::format("{},{:.4f}", m->frame, m->seconds) : std::string(",");
  };
  return fmt::format("{},{},{:.5f},{:.5f},{:.2f},{:.2f}", moment(time.converged()), moment(time.settled()),
                     time.changes().front(), time.changes().back(), frames.render_ms, denoise_ms);
}

void measure(const Options& o, const Dataset& data, const Animation& animation) {
  Sequence sequence(data, animation);
  Table steady(o, "variance-" + sequence.name(), "data,animation,spp,frame,method,variance_sum");
  Table rest(o, "convergence-" + sequence.name(),
             "data,animation,spp,frame,method,frames,seconds,settled_frames,settled_seconds,first_change,"
             "last_change,render_ms,denoise_ms");
  if (rest.exists()) return;
  std::vector<Method> methods = every_method(o.all_methods, false);
  std::erase_if(methods, [](const Method& m) { return m.name() == "oidn"; });
  for (const int moment : o.moments) {
    for (const int spp : o.spp) {
      const Frames frames = render_frames(o, sequence, moment, spp);
      for (Method& method : methods) {
        const std::string where =
            fmt::format("{},{},{},{},{},", data.name, animation.name, spp, moment, method.name());
        steady.add(where + fmt::format("{:.6g}", variance(method, frames)));
        rest.add(where + convergence(method, frames));
      }
    }
    fmt::print(stderr, "\rsteadiness: {} frame {} ", sequence.name(), moment);
  }
  fmt::print(stderr, "\n");
  steady.write();
  rest.write();
}

}  // namespace

void measure_steadiness(const Options& o) {
  for (const std::string& name : o.data) {
    const Dataset data = load_dataset(name, o.environment, o.width, o.height);
    for (const Animation& animation : animations()) {
      const bool chosen =
          o.animations.empty() || std::ranges::find(o.animations, animation.name) != o.animations.end();
      if (chosen) measure(o, data, animation);
    }
  }
}

}  // namespace voxlume::study
