#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "base/parallel.h"
#include "metrics/flip.h"
#include "metrics/metrics.h"
#include "study.h"

namespace voxlume::study {
namespace {

/// The frame in which soft matter vanishes (sequences.h), and frames after it that show what stays behind.
constexpr int kAbruptFrame = 60, kGhostFrames = 4;

/// How much of the picture before an abrupt change is still there: the share of `before` in the picture, by
/// least squares, as a mixture of `before` and `exact`.
double ghost_share(const Image& picture, const Image& exact, const Image& before) {
  double product = 0, squares = 0;
  for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
    const auto display = [](float v) { return pixel_value(v, PixelValues::kDisplay); };
    const double change = display(before.rgba[i]) - display(exact.rgba[i]);
    product += change * (display(picture.rgba[i]) - display(exact.rgba[i]));
    squares += change * change;
  }
  return squares > 0 ? product / squares : 0;
}

/// One sequence at one number of samples.
struct Run {
  int spp;
  std::vector<Method> methods;
  DenoiseFrame frame;
  GradientSampler gradients;
  std::map<std::string, std::array<double, 3>> sums;  ///< PSNR, FLIP and number of compared frames
};

std::vector<Method> methods_for(const Options& o, const Animation& animation, bool is_medium) {
  std::vector<Method> methods = every_method(o.all_methods);
  methods.push_back(still_method());
  const bool ablates = !is_medium && (animation.name == "orbit" || animation.name == "transfer");
  if (ablates) {
    for (Method& m : ablations()) methods.push_back(std::move(m));
  }
  return methods;
}

/// What a sequence's frames are for.
struct Plan {
  const Options& o;
  int frames;
  bool abrupt;  ///< soft matter vanishes

  bool compares(int f) const { return f % o.every == o.every - 1; }
  bool shows_ghosts(int f) const {
    return abrupt && f >= kAbruptFrame - 1 && f < kAbruptFrame + kGhostFrames;
  }
  bool looks_at(int f) const { return f < frames && (compares(f) || shows_ghosts(f)); }
  /// Whether it is looked at, or is history of a frame that is.
  bool renders(int f) const {
    for (int g = f; g < frames && (o.warm_up == 0 || g <= f + o.warm_up); ++g) {
      if (looks_at(g)) return true;
    }
    return false;
  }
};

struct Moment {
  int frame = 0, compared = 0;  ///< compared: how many frames were before
  bool is_compared = false, is_shown = false;
  const Reference* exact = nullptr;  ///< null: the frame is not looked at
  const FlipReference* exact_look = nullptr;
  const Image* before = nullptr;  ///< what was there before an abrupt change; null: there was none
};

/// What a method made of a frame, and how far that is from the exact picture.
struct Result {
  const Method* method;
  double ms;
  Image picture;
  double rmse, psnr_db, psnr_hdr_db, ssim, flip;

  void compare(const Image& exact, const FlipReference& exact_look) {
    rmse = voxlume::rmse(picture, exact);
    psnr_db = psnr(picture, exact).value_or(99);
    psnr_hdr_db = psnr_hdr(picture, exact).value_or(99);
    ssim = voxlume::ssim(picture, exact).value_or(1);
    flip = exact_look.compare(picture).mean;
  }
};

/// Every method denoises the frame; the results of those that are looked at.
std::vector<Result> denoise_all(const Options& o, const Moment& moment, Run& run) {
  std::vector<Result> results;
  for (Method& method : run.methods) {
    if (!method.has_history() && moment.exact == nullptr) continue;
    if (method.name() == "oidn" && (!moment.is_compared || moment.compared % o.neural_every != 0)) continue;
    const double ms = method.denoise(run.frame);
    if (moment.exact) results.push_back({&method, ms, method.picture(run.frame), 0, 0, 0, 0, 0});
  }
  return results;
}

void look(const Options& o, const Sequence& sequence, const Moment& moment, Run& run, double render_ms,
          Table& table) {
  std::vector<Result> results = denoise_all(o, moment, run);
  // Most of a comparison is done by one thread.
  parallel_for(static_cast<std::int64_t>(results.size()), 1, [&](std::int64_t i) {
    results[static_cast<std::size_t>(i)].compare(moment.exact->image, *moment.exact_look);
  });
  for (const Result& r : results) {
    const std::string& method = r.method->name();
    std::string ghost;
    if (moment.before)
      ghost = fmt::format("{:.5f}", ghost_share(r.picture, moment.exact->image, *moment.before));
    table.add(fmt::format("{},{},{},{},{},{},{:.6g},{:.4f},{:.4f},{:.5f},{:.5f},{},{:.2f},{:.1f}",
                          sequence.data().name, sequence.animation().name, run.spp, moment.frame, method,
                          moment.is_compared ? 1 : 0, r.rmse, r.psnr_db, r.psnr_hdr_db, r.ssim, r.flip, ghost,
                          r.ms, render_ms));
    if (moment.is_compared) {
      std::array<double, 3>& sums = run.sums[method];
      sums[0] += r.psnr_db, sums[1] += r.flip, sums[2] += 1;
    }
    if (moment.is_shown)
      write_display(o, r.picture,
                    fmt::format("{}-{:03d}-{}spp-{}", sequence.name(), moment.frame, run.spp, method));
  }
}

void forget(std::vector<Run>& runs) {
  for (Run& run : runs) {
    run.gradients.forget();
    for (Method& method : run.methods) method.forget();
  }
}

/// The reference of a moment, which is noted down with what is known of its noise.
Reference look_up(const Options& o, const Sequence& sequence, const Moment& moment, Table& table) {
  Reference exact = reference(o, sequence, moment.frame);
  if (moment.is_shown)
    write_display(o, exact.image, fmt::format("{}-{:03d}-reference", sequence.name(), moment.frame));
  table.add(fmt::format("{},{},{},{},reference,{},,{:.4f},,,{:.5f},,,", sequence.data().name,
                        sequence.animation().name, o.reference_spp, moment.frame, moment.is_compared ? 1 : 0,
                        exact.floor_db, exact.floor_flip));
  return exact;
}

void run_sequence(const Options& o, const Dataset& data, const Animation& animation, int frames,
                  bool is_medium) {
  Sequence sequence(data, animation);
  Table table(o, "over-time-" + sequence.name(),
              "data,animation,spp,frame,method,compared,rmse,psnr_db,psnr_hdr_db,ssim,flip,ghost,"
              "denoise_ms,render_ms");
  std::vector<Run> runs;
  for (const int spp : o.spp) runs.push_back({spp, methods_for(o, animation, is_medium), {}, {}, {}});
  const Plan plan{o, frames, animation.name == "transfer" && frames > kAbruptFrame};
  Image before;
  int compared = 0, last = -1;
  for (int f = 0; f < frames; ++f) {
    if (!plan.renders(f)) continue;
    if (f != last + 1) forget(runs);
    last = f;
    sequence.go_to(f);
    Moment moment{.frame = f, .compared = compared, .is_compared = plan.compares(f)};
    moment.is_shown = plan.abrupt ? f == kAbruptFrame + 1 : f + o.every >= frames;
    std::optional<Reference> exact;
    std::optional<FlipReference> exact_look;
    if (plan.looks_at(f)) {
      exact = look_up(o, sequence, moment, table);
      exact_look.emplace(exact->image);
      moment.exact = &*exact;
      moment.exact_look = &*exact_look;
      if (plan.shows_ghosts(f) && f >= kAbruptFrame) moment.before = &before;
    }
    for (Run& run : runs) {
      const double ms = sequence.render(run.spp, static_cast<std::uint32_t>(f), run.gradients, run.frame);
      look(o, sequence, moment, run, ms, table);
    }
    if (moment.is_compared) ++compared;
    if (exact && f < kAbruptFrame) before = std::move(exact->image);
    fmt::print(stderr, "\r{}: frame {}/{} ", sequence.name(), f + 1, frames);
  }
  fmt::print(stderr, "\n");
  for (const Run& run : runs) {
    for (const auto& [method, sums] : run.sums)
      fmt::print("{:28s} {:2d} spp {:24s} PSNR {:.2f} dB  FLIP {:.4f}\n", sequence.name(), run.spp, method,
                 sums[0] / sums[2], sums[1] / sums[2]);
  }
  std::fflush(stdout);
  table.write();
}

}  // namespace

void compare_over_time(const Options& o) {
  for_each_sequence(o, "over-time", [&](const Dataset& data, const Animation& animation) {
    run_sequence(o, data, animation, o.frames, false);
  });
  for (const std::string& name : o.media) {
    const Animation& orbit = find_animation("orbit");
    if (has_table(o, "over-time-" + name + "-" + orbit.name)) continue;
    run_sequence(o, load_dataset(name, o.environment, o.width, o.height), orbit,
                 std::min(o.frames, o.media_frames), true);
  }
}

}  // namespace voxlume::study
