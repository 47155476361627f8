// A look-up that asks the cells first, against one that does not.
#include "visibility/importance_cells.h"

#include <gtest/gtest.h>

#include "support/rule_volumes.h"
#include "visibility/importance_field.h"
#include "visibility/important_blocks.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::Placement;
using test::RuleVolumeSet;
using test::Size3;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr Size3 kSize{37, 30, 26};

/// Soft blobs of different places, values in [0, 100]; NaN in the share `holes`.
template <class T>
Volume blobs(Size3 size, int seed, const Placement& place = {}, double holes = 0) {
  Rng rng(static_cast<std::uint64_t>(seed), 0, 0, 0);
  Vec3d centers[4];
  for (Vec3d& center : centers)
    for (int a = 0; a < 3; ++a) center[a] = double{rng.next()} * static_cast<double>(size[a]);
  return make_volume<T>(
      size,
      [&](auto i, auto j, auto k) -> double {
        if (double{rng.next()} < holes) return kNaN;
        double most = 0;
        for (const Vec3d& center : centers) {
          const Vec3d off =
              Vec3d(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)) - center;
          most = std::max(most, 110 * std::exp(-dot(off, off) / 60) - 10);
        }
        return most;
      },
      place);
}

Volume labels(Size3 size, const Placement& place = {}) {
  return make_volume<std::uint8_t>(
      size, [](auto i, auto j, auto k) { return (i / 11 + 3 * (j / 9) + 7 * (k / 13)) % 6; }, place);
}

std::vector<std::pair<const char*, RuleVolumeSet>> volume_sets() {
  std::vector<std::pair<const char*, RuleVolumeSet>> sets;
  Placement inside, outside;
  inside.origin_mm = {-4.3, -3.9, -2.2};
  outside.origin_mm = {11.5, 9.25, 7};
  sets.emplace_back("the same grid", RuleVolumeSet(blobs<std::int16_t>(kSize, 1)));
  sets.back()
      .second.add("b", blobs<float>(kSize, 2), Lookup::kLinear)
      .add("l", labels(kSize), Lookup::kNearest);
  sets.emplace_back("a larger grid", RuleVolumeSet(blobs<std::uint8_t>(kSize, 3)));
  sets.back()
      .second.add("b", blobs<float>({50, 44, 40}, 4, inside), Lookup::kLinear)
      .add("l", labels({50, 44, 40}, inside), Lookup::kNearest);
  for (const Placement& place : test::placements()) {
    Placement other = place;
    other.spacing_mm = {place.spacing_mm[1] * 1.3, place.spacing_mm[2] * 0.9, place.spacing_mm[0]};
    sets.emplace_back("placed and turned", RuleVolumeSet(blobs<std::int16_t>(kSize, 5, place)));
    sets.back()
        .second.add("b", blobs<std::int16_t>({29, 35, 31}, 6, other), Lookup::kLinear)
        .add("l", labels({29, 35, 31}, other), Lookup::kNearest, Outline::kSmooth);
  }
  sets.emplace_back("partly outside", RuleVolumeSet(blobs<float>(kSize, 7)));
  sets.back()
      .second.add("b", blobs<float>({20, 20, 20}, 8, outside), Lookup::kLinear)
      .add("l", labels({20, 20, 20}, outside), Lookup::kNearest, Outline::kSmooth);
  sets.emplace_back("no numbers", RuleVolumeSet(blobs<float>(kSize, 9, {}, 1e-3)));
  sets.back()
      .second.add("b", blobs<float>({50, 44, 40}, 10, inside, 1e-3), Lookup::kLinear)
      .add("l", labels(kSize), Lookup::kNearest);
  sets.emplace_back("one voxel deep", RuleVolumeSet(blobs<std::int16_t>({60, 50, 1}, 11)));
  sets.back()
      .second.add("b", blobs<float>({60, 50, 1}, 12), Lookup::kLinear)
      .add("l", labels({60, 50, 1}), Lookup::kNearest, Outline::kSmooth);
  return sets;
}

class RandomImportance {
 public:
  RandomImportance(const RuleVolumeSet& volumes, Rng& rng) : volumes_(volumes), rng_(rng) {}

  std::vector<ImportanceRule> rules() {
    std::vector<ImportanceRule> out(static_cast<std::size_t>(1 + pick(4)));
    for (ImportanceRule& rule : out) rule = this->rule();
    return out;
  }

 private:
  int pick(int count) {
    return std::min(static_cast<int>(rng_.next() * static_cast<float>(count)), count - 1);
  }

  void put_range(int i, std::int32_t volume, ImportanceRule& rule) {
    const ValueRange values = volumes_.all()[static_cast<std::size_t>(volume)].values;
    const float width = values.upper - values.lower;
    rule.lower[i] = values.lower + width * rng_.next();
    rule.upper[i] = rng_.next() < 0.5f ? INFINITY : rule.lower[i] + width * rng_.next();
    if (rng_.next() < 0.3f) rule.lower[i] = std::round(rule.lower[i]);
    if (rng_.next() < 0.2f) rule.lower[i] = -INFINITY;
  }

  ImportanceRule rule() {
    ImportanceRule rule{};
    constexpr float kImportance[] = {0, 0.25f, 0.7f, 1};
    rule.importance = kImportance[pick(4)];
    rule.volume = rng_.next() < 0.7f ? pick(static_cast<int>(volumes_.all().size())) : -1;
    rule.along = rng_.next() < 0.3f ? pick(static_cast<int>(volumes_.all().size())) : -1;
    if (rule.volume >= 0) put_range(0, rule.volume, rule);
    if (rule.along >= 0) put_range(1, rule.along, rule);
    rule.box = {};
    const bool sphere = rng_.next() < 0.3f, box = !sphere && (rule.volume < 0 || rng_.next() < 0.3f);
    const GridView& main = volumes_.main();
    rule.center = main.world_from_index.point(test::random_point(volumes_.voxels(0), rng_));
    const float size = length(main.world_from_index.vector(main.index_box().extent()));
    if (sphere) rule.radius2 = size * size * 0.16f * rng_.next() * rng_.next();
    const Vec3f half = Vec3f(rng_.next(), rng_.next(), rng_.next()) * (0.4f * size);
    if (box) rule.box = {rule.center - half, rule.center + half};
    return rule;
  }

  const RuleVolumeSet& volumes_;
  Rng& rng_;
};

/// Points of the volume's domain; many on faces, edges and corners of cells, of voxels and of the domain, or
/// next to them.
Vec3f point_of(const Volume& main, Rng& rng, int n) {
  Vec3f p = test::random_point(main, rng);
  for (int a = 0; a < 3; ++a) {
    const float last = static_cast<float>(main.size[static_cast<std::size_t>(a)]) - 0.5f;
    if (n % 3 == 0 && (n >> (3 + a) & 1)) p[a] = std::round(std::max(p[a], 0.0f) / 2) * 2;
    if (n % 5 == 0 && (n >> (6 + a) & 1)) p[a] = std::floor(p[a]) + 0.5f;
    if (n % 7 == 0 && (n >> (6 + a) & 1)) p[a] = n & 64 ? -0.5f : last;
    if (n % 11 == 0) p[a] = std::nextafter(p[a], n & 32 ? -1e9f : 1e9f);
    p[a] = std::clamp(p[a], -0.5f, last);
  }
  return p;
}

TEST(ImportanceCells, ChangeNoLookUp) {
  Rng rng(31, 0, 0, 0);
  for (const auto& [name, volumes] : volume_sets()) {
    SCOPED_TRACE(name);
    RandomImportance random(volumes, rng);
    int wrong = 0, points = 0, known = 0, known_important = 0;
    for (int set = 0; set < 60; ++set) {
      constexpr ImportanceLookup kLookups[] = {ImportanceLookup::kInterpolated,
                                               ImportanceLookup::kInterpolated, ImportanceLookup::kPerVoxel,
                                               ImportanceLookup::kSmoothed};
      const std::vector<ImportanceRule> rules = random.rules();
      const ImportanceField field(rules, volumes.all(), kLookups[set % 4]);
      ImportanceView view = field.view();
      const int side = 1 << set / 4 % 4;
      const ImportanceCells cells = view.lookup == ImportanceLookup::kInterpolated
                                        ? ImportanceCells(rules, volumes.all(), side)
                                        : ImportanceCells(rules, view.voxels, side);
      if (set >= 20) view.cells = cells.view();
      for (int n = 0; n < 4000; ++n, ++points) {
        const Vec3f p = point_of(volumes.voxels(0), rng, n);
        const float expected = look_up_importance(view, p);
        if (importance_at(view, p) != expected && ++wrong < 4)
          ADD_FAILURE() << "rules " << set << " at " << p.x << " " << p.y << " " << p.z << ": "
                        << importance_at(view, p) << ", not " << expected;
        const std::uint8_t level = view.cells.level_at(p);
        known += level != ImportanceCellsView::kMixed;
        known_important += level != ImportanceCellsView::kMixed && level != 0;
        if (expected > 0) {
          EXPECT_TRUE(view.cells.important.contains(p));
        }
      }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(known, points / 3);
    EXPECT_GT(known_important, points / 50);
  }
}

/// No point that is important, were it off by half a voxel, is outside the part of its line.
TEST(ImportantBlocks, LeaveNothingOut) {
  Rng rng(32, 0, 0, 0);
  for (const auto& [name, volumes] : volume_sets()) {
    SCOPED_TRACE(name);
    RandomImportance random(volumes, rng);
    const Box3f domain = volumes.main().index_box();
    int wrong = 0, none = 0, lines = 0, parts = 0;
    for (int set = 0; set < 30; ++set) {
      const std::vector<ImportanceRule> rules = random.rules();
      ImportanceView view =
          ImportanceView(ImportanceField(rules, volumes.all(), ImportanceLookup::kInterpolated).view());
      const ImportanceCells cells(rules, volumes.all(), 1 << set % 3);
      const ImportantBlocks blocks(cells.view());
      view.rules = rules.data();
      view.cells = cells.view();
      for (int n = 0; n < 100; ++n, ++lines) {
        const Vec3f from = test::random_point(volumes.voxels(0), rng);
        Vec3f direction = Vec3f(rng.next(), rng.next(), rng.next()) - Vec3f(0.5f);
        if (n % 4 == 0) direction = {n % 8 ? 1.0f : 0.0f, 0, n % 8 ? 0.0f : -1.0f};
        const Vec3f origin = from - direction * 50;
        const auto run = clip_ray(domain, origin, direction, 0.0f, 1e9f);
        const auto part = blocks.part_of(origin, direction, run.t_near, run.t_far);
        none += part.t_near > part.t_far;
        parts += part.t_near > run.t_near || part.t_far < run.t_far;
        for (int i = 0; i < 200; ++i) {
          const float t = run.t_near + (run.t_far - run.t_near) * rng.next();
          const Vec3f off =
              (Vec3f(rng.next(), rng.next(), rng.next()) - Vec3f(0.5f)) * (i % 2 ? 0.98f : 0.0f);
          const Vec3f p = min(max(origin + direction * t + off, domain.lower), domain.upper);
          const bool left_out = t < part.t_near || t > part.t_far || part.t_near > part.t_far;
          if (left_out && importance_at(view, p) > 0 && ++wrong < 4)
            ADD_FAILURE() << "rules " << set << ": " << p.x << " " << p.y << " " << p.z << " at " << t
                          << ", not from " << part.t_near << " to " << part.t_far;
        }
      }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(none, lines / 20);
    EXPECT_GT(parts, lines / 4);
  }
}

TEST(ImportanceCells, PointsOutsideTheVolumeAreLookedUp) {
  const RuleVolumeSet volumes(blobs<std::int16_t>(kSize, 1));
  ImportanceRule rule{};
  rule.importance = 1;
  rule.box = {Vec3f(-100, -100, -100), Vec3f(-10, 100, 100)};
  const ImportanceField field({rule}, volumes.all(), ImportanceLookup::kInterpolated);
  EXPECT_EQ(importance_at(field.view(), {-20, 0, 0}), 1);
  EXPECT_EQ(importance_at(field.view(), {0, 0, 0}), 0);
  EXPECT_TRUE(field.view().cells.important.empty());
}

/// Cells cannot be told apart by more than 254 importances; the others are looked up.
TEST(ImportanceCells, HoldForManyImportances) {
  const RuleVolumeSet volumes(make_volume<std::int16_t>({600, 3, 3}, [](auto i, auto, auto) { return i; }));
  std::vector<ImportanceRule> rules(500);
  for (std::size_t i = 0; i < rules.size(); ++i) {
    rules[i] = {};
    rules[i].importance = static_cast<float>(i + 1) / 500;
    rules[i].volume = 0;
    rules[i].lower[0] = static_cast<float>(i);
    rules[i].upper[0] = INFINITY;
    rules[i].box = {};
  }
  const ImportanceField field(rules, volumes.all(), ImportanceLookup::kInterpolated);
  Rng rng(5, 0, 0, 0);
  for (int n = 0; n < 5000; ++n) {
    const Vec3f p = test::random_point(volumes.voxels(0), rng);
    EXPECT_EQ(importance_at(field.view(), p), look_up_importance(field.view(), p));
  }
}

}  // namespace
}  // namespace voxlume
