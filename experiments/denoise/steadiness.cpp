#include <fmt/format.h>

#include <algorithm>

#include "metrics/temporal.h"
#include "study.h"

namespace voxlume::study {
namespace {

/// Seeds of pictures of one moment, and of frames in which nothing moves any more.
constexpr std::uint32_t kMomentSeed = 10000, kRestSeed = 20000;

/// A method and what is measured of it.
struct Subject {
  Method method;
  TemporalVariance variance;
  ConvergenceTime convergence;
  double seconds = 0;     ///< since nothing moves
  double denoise_ms = 0;  ///< of the last frame
};

std::vector<Subject> subjects(const Options& o) {
  std::vector<Subject> all;
  for (Method& method : every_method(o.all_methods)) {
    // A network needs most of a second a frame and has no history.
    if (method.name() != "oidn") all.push_back({std::move(method), TemporalVariance(), ConvergenceTime()});
  }
  return all;
}

/// Frames just before a moment, the last of which `gradients` has seen.
std::vector<DenoiseFrame> render_history(const Options& o, Sequence& sequence, int moment, int spp,
                                         GradientSampler& gradients) {
  std::vector<DenoiseFrame> frames;
  for (int f = std::max(moment - o.history, 0); f < moment; ++f) {
    sequence.go_to(f);
    sequence.render(spp, static_cast<std::uint32_t>(f), gradients, frames.emplace_back());
  }
  return frames;
}

/// The history is played anew for each seed: denoisers cannot be copied.
void replay(Method& method, const std::vector<DenoiseFrame>& history) {
  method.forget();
  if (!method.has_history()) return;
  for (const DenoiseFrame& frame : history) method.denoise(frame);
}

/// `gradients` has seen the history; in the end, the last picture too.
void measure_variance(const Options& o, const Sequence& sequence, int spp,
                      const std::vector<DenoiseFrame>& history, GradientSampler& gradients,
                      std::vector<Subject>& all) {
  const GradientSampler before = gradients;
  DenoiseFrame frame;
  for (int i = 0; i < o.seeds; ++i) {
    gradients = before;
    sequence.render(spp, kMomentSeed + static_cast<std::uint32_t>(i), gradients, frame);
    for (Subject& s : all) {
      replay(s.method, history);
      s.method.denoise(frame);
      s.variance.add(s.method.picture(frame));
    }
  }
  // What is on show when everything stops.
  for (Subject& s : all) s.convergence.add(s.method.picture(frame), 0);
}

/// Goes on from the last picture of measure_variance. The mean time to render a frame [ms].
double measure_convergence(const Options& o, const Sequence& sequence, int spp, GradientSampler& gradients,
                           std::vector<Subject>& all) {
  DenoiseFrame frame;
  double sum_ms = 0;
  for (int i = 0; i < o.rest; ++i) {
    const double render_ms =
        sequence.render(spp, kRestSeed + static_cast<std::uint32_t>(i), gradients, frame);
    sum_ms += render_ms;
    for (Subject& s : all) {
      s.denoise_ms = s.method.denoise(frame);
      s.seconds += (render_ms + s.denoise_ms) / 1000;
      s.convergence.add(s.method.picture(frame), s.seconds);
    }
  }
  return sum_ms / o.rest;
}

std::string convergence_columns(const Subject& s, double render_ms) {
  const auto moment = [](const std::optional<ConvergenceTime::Moment>& m) {
    return m ? fmt::format("{},{:.4f}", m->frame, m->seconds) : std::string(",");
  };
  return fmt::format("{},{},{:.5f},{:.5f},{:.2f},{:.2f}", moment(s.convergence.converged()),
                     moment(s.convergence.settled()), s.convergence.changes().front(),
                     s.convergence.changes().back(), render_ms, s.denoise_ms);
}

void measure(const Options& o, const Dataset& data, const Animation& animation) {
  Sequence sequence(data, animation);
  Table steady(o, "variance-" + sequence.name(), "data,animation,spp,frame,method,variance_sum");
  Table rest(o, "convergence-" + sequence.name(),
             "data,animation,spp,frame,method,frames,seconds,settled_frames,settled_seconds,first_change,"
             "last_change,render_ms,denoise_ms");
  for (const int moment : o.moments) {
    for (const int spp : o.spp) {
      std::vector<Subject> all = subjects(o);
      GradientSampler gradients;
      const std::vector<DenoiseFrame> history = render_history(o, sequence, moment, spp, gradients);
      sequence.go_to(moment);
      measure_variance(o, sequence, spp, history, gradients, all);
      const double render_ms = measure_convergence(o, sequence, spp, gradients, all);
      for (const Subject& s : all) {
        const std::string where =
            fmt::format("{},{},{},{},{},", data.name, animation.name, spp, moment, s.method.name());
        steady.add(where + fmt::format("{:.6g}", s.variance.sum()));
        rest.add(where + convergence_columns(s, render_ms));
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
  for_each_sequence(o, "convergence",
                    [&](const Dataset& data, const Animation& animation) { measure(o, data, animation); });
}

}  // namespace voxlume::study
