// Measures what transfer functions of several volumes cost: a look-up of the extinction, by classify_mu_t
// over points near each other and by a small render (one thread), and the update of the majorants for every
// kind of rule on a volume stretched to cubes of 256^3 voxels, or of other edges. Prints JSON. Usage:
// voxlume_rules VOLUME [EDGE...]
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "measure.h"
#include "stretched.h"
#include "voxlume/error.h"
#include "voxlume/volume_io.h"

namespace {

using namespace voxlume;
using Json = nlohmann::ordered_json;

constexpr int kLabels = 40;

/// Blobs of labels 1 to kLabels in background, on the grid of `like`.
Volume label_volume(const Volume& like) {
  auto voxels = std::make_shared<std::vector<std::uint8_t>>(like.voxel_count());
  parallel_for(like.size[2], 1, [&](std::int64_t k) {
    for (std::int64_t j = 0; j < like.size[1]; ++j)
      for (std::int64_t i = 0; i < like.size[0]; ++i) {
        const std::int64_t at[3] = {i, j, k};
        std::uint32_t block = 0;
        double distance2 = 0;
        for (int a = 0; a < 3; ++a) {
          const std::int64_t place = at[a] * 64;  // 8 blocks of 8 a side
          block = block * 8 + static_cast<std::uint32_t>(place / (8 * like.size[a]));
          const double x =
              static_cast<double>(place % (8 * like.size[a])) / static_cast<double>(like.size[a]) - 4;
          distance2 += x * x;
        }
        const bool inside = distance2 < 9;
        (*voxels)[static_cast<std::size_t>((k * like.size[1] + j) * like.size[0] + i)] =
            static_cast<std::uint8_t>(inside ? 1 + block * 2654435761u % kLabels : 0);
      }
  });
  Volume out = like;
  out.type = VoxelType::kU8;
  out.voxels = std::shared_ptr<const void>(voxels, voxels->data());
  return out;
}

TransferPoint point(double value, double opacity) {
  TransferPoint out;
  out.value = value;
  out.opacity = opacity;
  return out;
}

RuleDescription rule(RuleKind kind, const char* volume, std::vector<TransferPoint> points) {
  RuleDescription out;
  out.kind = kind;
  out.volume = volume;
  out.points = std::move(points);
  return out;
}

/// The rule with a second volume: three columns, of which the first has half the opacity.
RuleDescription along(RuleDescription from, const char* volume, ColumnForm form, std::vector<double> at) {
  from.along = volume;
  from.column_form = form;
  for (std::size_t i = 0; i < at.size(); ++i) {
    from.columns.push_back({at[i], from.points});
    if (i == 0)
      for (TransferPoint& p : from.columns[0].points) *p.opacity *= 0.5;
  }
  from.points.clear();
  return from;
}

struct Case {
  const char* name;
  const char* volumes;
  std::vector<RuleDescription> rules;
  Merge merge = Merge::kPriority;
};

std::vector<TransferPoint> curve() { return {point(100, 0), point(300, 0.3), point(1500, 0.9)}; }
std::vector<TransferPoint> thin() { return {point(50, 0.01), point(1500, 0.05)}; }
std::vector<TransferPoint> ramp(double upper) { return {point(0, 0.2), point(upper, 1)}; }
std::vector<TransferPoint> labels(const char* material) {
  std::vector<TransferPoint> out;
  for (int label = 1; label <= kLabels; label += 3) {
    out.push_back(point(label, 0.7));
    out.back().material = material;
  }
  return out;
}

/// Every kind, and what look-ups cost with 1, 2 and 4 volumes. All have the curve of the data besides.
std::vector<Case> cases() {
  using enum RuleKind;
  const auto with_material = [](std::vector<TransferPoint> points) {
    for (TransferPoint& p : points) p.material = "bone";
    return points;
  };
  const RuleDescription data = rule(kCoefficientCurve, "data", curve());
  const RuleDescription steep = rule(kCoefficientCurve, "gradient", ramp(400));
  const RuleDescription smooth = rule(kCoefficientCurve, "smooth", ramp(2000));
  const RuleDescription organs = rule(kCoefficientPoints, "organs", labels(""));
  return {
      {"none", "1", {}},
      {"cctf", "1", {data}},
      {"cpctf", "1", {rule(kCoefficientSteps, "data", curve())}},
      {"cctf that hides little", "1", {rule(kCoefficientCurve, "data", thin())}},
      {"mpctf of the opacity", "1", {rule(kMaterialSteps, "opacity", with_material({point(0.5, 0.9)}))}},
      {"cctf x cctf", "2", {data, steep}, Merge::kProduct},
      {"cctf along a gradient (2-D)", "2", {along(data, "gradient", ColumnForm::kCurve, {0, 100, 400})}},
      {"cctf of the opacity along it (2-D)",
       "1",
       {along(rule(kCoefficientCurve, "opacity", ramp(1)), "opacity", ColumnForm::kCurve, {0, 0.3, 0.9})}},
      {"cctf along labels (2-D)", "2", {along(data, "organs", ColumnForm::kPoints, {0, 4, 7})}},
      {"cdptf", "2", {organs}},
      {"mdptf", "2", {rule(kMaterialPoints, "organs", labels("bone"))}},
      {"greatest of 4", "4", {data, steep, smooth, organs}, Merge::kMaximum},
      {"cdptf, then 2-D, 2-D",
       "4",
       {organs, along(smooth, "gradient", ColumnForm::kCurve, {0, 100, 400}),
        along(data, "smooth", ColumnForm::kSteps, {-2000, 0, 500})}}};
}

SceneDescription scene_of(const Case& one, const std::string& label_file) {
  SceneDescription scene;
  ProxyDescription gradient, smooth, organs;
  gradient.name = "gradient";
  gradient.kind = ProxyKind::kGradient;
  smooth.name = "smooth";
  smooth.kind = ProxyKind::kSmoothed;
  organs.name = "organs";
  organs.path = label_file;
  organs.lookup = Lookup::kNearest;
  scene.proxies = {gradient, smooth, organs};
  scene.transfer.points = curve();
  scene.transfer.reference_length_mm = 1;
  scene.transfer.rules = one.rules;
  scene.transfer.merge = one.merge;
  scene.image.width = scene.image.height = 256;
  return scene;
}

/// Nanoseconds of a look-up of data and extinction on one thread. Walks of short steps: memory is near.
double lookup_ns(const Medium& medium) {
  constexpr int kWalks = 4000, kSteps = 250;
  std::vector<double> times;
  double sum = 0;
  for (int round = 0; round < 5; ++round) {
    Rng rng(1, 0, 0, 0);
    const Box3f box = medium.grid.index_box();
    const double begin = processor_ms();
    for (int walk = 0; walk < kWalks; ++walk) {
      Vec3f p = box.lower + box.extent() * Vec3f(rng.next(), rng.next(), rng.next());
      const Vec3f step(rng.next() - 0.5f, rng.next() - 0.5f, rng.next() - 0.5f);
      for (int n = 0; n < kSteps; ++n) {
        p = min(max(p + step, box.lower), box.upper);
        sum += static_cast<double>(extinction_at(medium, p));
      }
    }
    times.push_back(processor_ms() - begin);
  }
  if (sum < 0) std::printf("never\n");
  return 1e6 * median(times) / (kWalks * kSteps);
}

/// What it takes to edit the rules there and back, in wall time and in processor time of all threads.
struct UpdateTimes {
  std::vector<double> wall_ms, processor_ms;
};

UpdateTimes time_updates(CompiledScene& scene, const SceneDescription& one, const SceneDescription& other) {
  UpdateTimes out;
  for (int round = 0; round < 10; ++round) {
    const double begin = processor_ms();
    scene.update(round % 2 ? one : other);
    out.processor_ms.push_back(processor_ms() - begin);
    out.wall_ms.push_back(scene.majorant_build_ms());
  }
  return out;
}

void measure(const Volume& volume, const std::string& label_file, Json& rows) {
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  std::unique_ptr<CompiledScene> scene;
  for (const Case& one : cases()) {
    SceneDescription description = scene_of(one, label_file);
    const SceneDescription resolved = resolve(description, volume, statistics);
    description.transfer.density_scale = 1.25;
    const SceneDescription denser = resolve(description, volume, statistics);
    if (!scene) scene = std::make_unique<CompiledScene>(resolved, volume, statistics);
    scene->update(resolved);
    const UpdateTimes updates = time_updates(*scene, resolved, denser);
    const TimedRender render = render_on_one_thread(*scene, 1);
    const auto steps = static_cast<double>(render.counters.tracking_steps);
    rows.push_back({{"edge_voxels", volume.size[0]},
                    {"rules_over_a_curve", one.name},
                    {"volumes", one.volumes},
                    {"lookup_ns", lookup_ns(scene->view().medium)},
                    {"render_ns_per_step", 1e6 * render.processor_ms / steps},
                    {"update_ms", median(updates.wall_ms)},
                    {"update_least_ms", *std::min_element(updates.wall_ms.begin(), updates.wall_ms.end())},
                    {"update_processor_ms", median(updates.processor_ms)}});
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: voxlume_rules VOLUME [EDGE...]\n");
    return 2;
  }
  const std::filesystem::path label_file =
      std::filesystem::temp_directory_path() / ("voxlume-rules-" + std::to_string(::getpid()) + ".nrrd");
  int code = 0;
  try {
    VolumeDescription description;
    description.path = argv[1];
    const Volume head = open_volume(description);
    std::vector<int> edges{256};
    if (argc > 2) edges.clear();
    for (int i = 2; i < argc; ++i) edges.push_back(std::atoi(argv[i]));
    Json rows;
    for (const int edge : edges) {
      const Volume volume = stretched(head, edge);
      write_volume(label_volume(volume), label_file);
      measure(volume, label_file, rows);
    }
    std::printf("%s\n",
                Json{{"volume", argv[1]}, {"threads", thread_count()}, {"rows", rows}}.dump(2).c_str());
  } catch (const Error& error) {
    std::fprintf(stderr, "voxlume_rules: %s\n", error.what());
    code = 1;
  }
  std::error_code ignored;
  std::filesystem::remove(label_file, ignored);
  return code;
}
