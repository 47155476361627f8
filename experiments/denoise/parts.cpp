#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "base/parallel.h"
#include "film/tile.h"
#include "integrator/path_tracer.h"
#include "study.h"

namespace voxlume::study {
namespace {

/// Samples of a pixel that are classified together, as those of a frame are, and how many such batches.
constexpr int kBatch = 30, kBatches = 16;
constexpr int kMostClasses = 3;

Vec3f ratio(Vec3f a, Vec3f b) {
  return {b.x > 0 ? a.x / b.x : 0.0f, b.y > 0 ? a.y / b.y : 0.0f, b.z > 0 ? a.z / b.z : 0.0f};
}

/// Samples [begin, end) of sorted ones: what a class of them has for its share of the sum if it is the
/// product of the means of fx and of fl, fl of a sample being its direct light over its fx (xu2024 eqs. 9 and
/// 10).
Vec3d product_of_means(std::span<const RadianceParts* const> samples) {
  Vec3d fx_diffuse, fx_specular, fl_diffuse, fl_specular, later;
  for (const RadianceParts* p : samples) {
    fx_diffuse += Vec3d(p->fx_diffuse);
    fx_specular += Vec3d(p->fx_specular);
    fl_diffuse += Vec3d(ratio(p->direct_diffuse, p->fx_diffuse));
    fl_specular += Vec3d(ratio(p->direct_specular, p->fx_specular));
    later += Vec3d(p->later);
  }
  const double inverse = samples.empty() ? 0 : 1.0 / static_cast<double>(samples.size());
  return (fx_diffuse * fl_diffuse + fx_specular * fl_specular) * inverse + later;
}

/// Sum of a pixel's samples, which are sorted by the luminance of fx, divided at the largest gaps.
Vec3d by_classes(std::span<const RadianceParts* const> sorted, int classes) {
  const std::size_t count = sorted.size();
  std::vector<std::pair<float, std::size_t>> gaps;
  for (std::size_t i = 1; i < count; ++i)
    gaps.push_back({luminance(sorted[i]->fx_diffuse) - luminance(sorted[i - 1]->fx_diffuse), i});
  std::ranges::sort(gaps, std::greater<>());
  std::vector<std::size_t> cuts{0, count};
  const bool alike =
      count < 2 || luminance(sorted.back()->fx_diffuse) - luminance(sorted[0]->fx_diffuse) < Film::kOneClass;
  for (int k = 1; k < classes && !alike && k <= static_cast<int>(gaps.size()); ++k)
    cuts.push_back(gaps[k - 1].second);
  std::ranges::sort(cuts);
  Vec3d sum;
  for (std::size_t i = 1; i < cuts.size(); ++i)
    sum += product_of_means(sorted.subspan(cuts[i - 1], cuts[i] - cuts[i - 1]));
  return sum;
}

/// Means over all samples: of each part, of the light of matter, and what 1, 2 and 3 classes make of it.
struct Pictures {
  Image fx_diffuse, fx_specular, fl_diffuse, fl_specular, later, exact;
  Image classes[kMostClasses];
};

struct PixelSums {
  Vec3d fx_diffuse, fx_specular, direct_diffuse, direct_specular, later, classes[kMostClasses];

  void add(std::span<const PixelSample> samples, std::span<const RadianceParts> parts) {
    std::vector<const RadianceParts*> sorted;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      if (!(samples[i].alpha > 0)) continue;
      const RadianceParts& p = parts[i];
      sorted.push_back(&p);
      fx_diffuse += Vec3d(p.fx_diffuse);
      fx_specular += Vec3d(p.fx_specular);
      direct_diffuse += Vec3d(p.direct_diffuse);
      direct_specular += Vec3d(p.direct_specular);
      later += Vec3d(p.later);
    }
    std::ranges::sort(sorted, {}, [](const RadianceParts* p) { return luminance(p->fx_diffuse); });
    for (int k = 0; k < kMostClasses; ++k) classes[k] += by_classes(sorted, k + 1);
  }

  void put(Pictures& out, int x, int y, double count) const {
    const auto set = [&](Image& image, Vec3d value) {
      float* pixel = image.pixel(x, y);
      for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(value[c]);
      pixel[3] = 1;
    };
    const double inverse = 1 / count;
    set(out.fx_diffuse, fx_diffuse * inverse);
    set(out.fx_specular, fx_specular * inverse);
    set(out.fl_diffuse, Vec3d(ratio(Vec3f(direct_diffuse), Vec3f(fx_diffuse))));
    set(out.fl_specular, Vec3d(ratio(Vec3f(direct_specular), Vec3f(fx_specular))));
    set(out.later, later * inverse);
    set(out.exact, (direct_diffuse + direct_specular + later) * inverse);
    for (int k = 0; k < kMostClasses; ++k) set(out.classes[k], classes[k] * inverse);
  }
};

Pictures trace(const Sequence& sequence) {
  SceneView view = sequence.view();
  view.keeps_parts = true;
  Pictures out;
  for (Image* i : {&out.fx_diffuse, &out.fx_specular, &out.fl_diffuse, &out.fl_specular, &out.later,
                   &out.exact, &out.classes[0], &out.classes[1], &out.classes[2]})
    *i = Image(view.width, view.height);
  const std::vector<TileRect> tiles = make_tiles(view.width, view.height, 16);
  parallel_for(static_cast<std::int64_t>(tiles.size()), 1, [&](std::int64_t i) {
    const TileRect& tile = tiles[i];
    TraceCounters counters;
    const std::size_t pixels = tile.pixel_count();
    std::vector<PixelSample> samples(pixels * kBatch);
    std::vector<RadianceParts> parts(pixels * kBatch);
    std::vector<PixelSums> sums(pixels);
    for (int b = 0; b < kBatches; ++b) {
      trace_tile(view, tile, b * kBatch, (b + 1) * kBatch, samples, parts, counters);
      for (std::size_t p = 0; p < pixels; ++p)
        sums[p].add(std::span(samples).subspan(p * kBatch, kBatch),
                    std::span(parts).subspan(p * kBatch, kBatch));
    }
    for (std::size_t p = 0; p < pixels; ++p)
      sums[p].put(out, tile.x0 + static_cast<int>(p) % tile.width(),
                  tile.y0 + static_cast<int>(p) / tile.width(), kBatch * kBatches);
  });
  return out;
}

/// Mean absolute error and the mean error, both over the mean of `exact`.
std::string relative_errors(const Image& image, const Image& exact) {
  double apart = 0, bias = 0, mean = 0;
  for (std::size_t i = 0; i < exact.rgba.size(); ++i) {
    if (i % 4 == 3) continue;
    const double d = image.rgba[i] - exact.rgba[i];
    apart += std::abs(d);
    bias += d;
    mean += exact.rgba[i];
  }
  return fmt::format("{:.5f},{:.5f}", apart / mean, bias / mean);
}

/// The absolute error, ten times.
Image error_map(const Image& image, const Image& exact) {
  constexpr float kGain = 10;
  Image out = exact;
  for (std::size_t i = 0; i < out.rgba.size(); ++i)
    out.rgba[i] = i % 4 == 3 ? 1 : kGain * std::abs(image.rgba[i] - exact.rgba[i]);
  return out;
}

}  // namespace

void show_parts(const Options& o) {
  Table table(o, "classes", "data,classes,mean_absolute_error,mean_error");
  if (has_table(o, "classes")) return;
  for (const std::string& name : o.data) {
    Dataset data = load_dataset(name, o.environment, o.width, o.height);
    // Where matter of several kinds lies behind one another.
    data.scene.transfer.points = data.edited;
    Sequence sequence(data, find_animation("still"));
    sequence.go_to(0);
    const Pictures pictures = trace(sequence);
    write_display(o, pictures.fx_diffuse, "parts-" + name + "-fx-diffuse");
    write_display(o, pictures.fx_specular, "parts-" + name + "-fx-specular");
    write_display(o, pictures.fl_diffuse, "parts-" + name + "-fl-diffuse");
    write_display(o, pictures.fl_specular, "parts-" + name + "-fl-specular");
    write_display(o, pictures.later, "parts-" + name + "-later");
    write_display(o, pictures.exact, "parts-" + name + "-all");
    for (int k = 0; k < kMostClasses; ++k) {
      table.add(fmt::format("{},{},{}", name, k + 1, relative_errors(pictures.classes[k], pictures.exact)));
      write_display(o, error_map(pictures.classes[k], pictures.exact),
                    fmt::format("classes-{}-error-{}", name, k + 1));
    }
    fmt::print(stderr, "parts: {}\n", name);
  }
  table.write();
}

}  // namespace voxlume::study
