#include <fmt/format.h>

#include <algorithm>

#include "metrics/flip.h"
#include "metrics/metrics.h"
#include "metrics/temporal.h"
#include "study.h"

namespace voxlume::study {
namespace {

/// Frames in a row, of which the last is compared.
constexpr int kSweepFrames = 8, kSweepEnd = 31;

void sweep(const Options& o, const std::string& name) {
  Table table(o, "sweep-" + name, "data,spp,method,psnr_db,flip,render_ms,denoise_ms,frames_per_second");
  if (has_table(o, "sweep-" + name)) return;
  const Dataset data = load_dataset(name, o.environment, o.width, o.height);
  Sequence sequence(data, find_animation("orbit"));
  const int end = std::min(kSweepEnd, o.frames - 1);
  sequence.go_to(end);
  const Reference exact = reference(o, sequence, end);
  DenoiseFrame frame;
  for (const int spp : o.sweep) {
    std::vector<Method> methods = every_method(o.all_methods);
    std::vector<double> denoise_ms(methods.size());
    std::vector<double> render_ms;
    GradientSampler gradients;
    for (int f = std::max(end - kSweepFrames + 1, 0); f <= end; ++f) {
      sequence.go_to(f);
      render_ms.push_back(sequence.render(spp, static_cast<std::uint32_t>(f), gradients, frame));
      for (std::size_t i = 0; i < methods.size(); ++i) {
        if (methods[i].has_history() || f == end) denoise_ms[i] = methods[i].denoise(frame);
      }
    }
    std::ranges::nth_element(render_ms,
                             render_ms.begin() + static_cast<std::ptrdiff_t>(render_ms.size() / 2));
    const double typical_ms = render_ms[render_ms.size() / 2];
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const Image picture = methods[i].picture(frame);
      table.add(fmt::format("{},{},{},{:.4f},{:.5f},{:.2f},{:.2f},{:.3f}", name, spp, methods[i].name(),
                            psnr(picture, exact.image).value_or(99), flip(picture, exact.image).mean,
                            typical_ms, denoise_ms[i], 1000 / (typical_ms + denoise_ms[i])));
    }
    fmt::print(stderr, "\rsweep: {} {} spp ", name, spp);
  }
  fmt::print(stderr, "\n");
  table.write();
}

/// Share of pixels that are far off in any channel of the display: spikes, of noise or what became of it.
double spike_share(const Image& picture, const Image& exact) {
  constexpr double kFar = 0.2;
  std::size_t spikes = 0;
  for (std::size_t i = 0; i < picture.pixel_count(); ++i) {
    double error = 0;
    for (int c = 0; c < 3; ++c)
      error = std::max(error, std::abs(pixel_value(picture.rgba[4 * i + c], PixelValues::kDisplay) -
                                       pixel_value(exact.rgba[4 * i + c], PixelValues::kDisplay)));
    spikes += error > kFar ? 1 : 0;
  }
  return static_cast<double>(spikes) / static_cast<double>(picture.pixel_count());
}

constexpr int kStillFrames = 24, kStillWarmUp = 12;

}  // namespace

void sweep_samples(const Options& o) {
  if (!o.data.empty()) sweep(o, o.data.front());
  if (!o.media.empty()) sweep(o, o.media.front());
}

void stand_still_study(const Options& o) {
  Table table(o, "still", "data,spp,method,psnr_db,flip,variance_sum,spike_share");
  if (has_table(o, "still") || o.media.empty()) return;
  const Dataset data = load_dataset("spiky", o.environment, o.width, o.height);
  Sequence sequence(data, find_animation("still"));
  sequence.go_to(0);
  const Reference exact = reference(o, sequence, 0);
  write_display(o, exact.image, "still-reference");
  const int spp = o.spp.front();
  std::vector<Method> methods = every_method(o.all_methods);
  std::erase_if(methods, [](const Method& m) { return m.name() == "oidn"; });
  std::vector<TemporalVariance> variances(methods.size());
  DenoiseFrame frame;
  GradientSampler gradients;
  for (int f = 0; f < kStillFrames; ++f) {
    sequence.render(spp, static_cast<std::uint32_t>(f), gradients, frame);
    for (std::size_t i = 0; i < methods.size(); ++i) {
      methods[i].denoise(frame);
      if (f >= kStillWarmUp) variances[i].add(methods[i].picture(frame));
    }
  }
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const Image picture = methods[i].picture(frame);
    table.add(fmt::format("{},{},{},{:.4f},{:.5f},{:.6g},{:.6f}", data.name, spp, methods[i].name(),
                          psnr(picture, exact.image).value_or(99), flip(picture, exact.image).mean,
                          variances[i].sum(), spike_share(picture, exact.image)));
    write_display(o, picture, "still-" + methods[i].name());
  }
  table.write();
}

}  // namespace voxlume::study
