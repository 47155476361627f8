#include "grid/cell_ranges.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>

#include "base/parallel.h"
#include "grid/label_outline.h"
#include "support/volumes.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::noise_volume;
using test::Placement;
using test::Size3;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Rotation by `angle` about the axis (1,2,2)/3.
std::array<double, 9> turned(double angle) {
  const double u[3] = {1.0 / 3, 2.0 / 3, 2.0 / 3}, c = std::cos(angle), s = std::sin(angle);
  const double across[9] = {0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0};
  std::array<double, 9> m{};
  for (int r = 0; r < 3; ++r)
    for (int q = 0; q < 3; ++q)
      m[3 * r + q] = (r == q ? c : 0) + s * across[3 * r + q] + (1 - c) * u[r] * u[q];
  return m;
}

const Placement kMain{{0.9, 1.1, 1.7}, {-120, 40, 300}, turned(0.3)};

/// Places for a proxy: the main grid's own, shifted, other spacings, turned, partly and wholly outside.
std::vector<Placement> proxy_places() {
  std::vector<Placement> places{kMain, kMain, kMain, kMain, kMain, kMain, kMain};
  places[1].origin_mm = {-119.5, 41.25, 300.125};
  places[2].spacing_mm = {0.4, 2.3, 1.1};
  places[3].direction = turned(1.4);
  places[4] = {{1.3, 0.6, 0.8}, {-118, 45, 297}, turned(-2.2)};
  places[5].origin_mm = {-112, 48, 303};
  places[6].origin_mm = {500, 40, 300};
  return places;
}

/// Whatever is kept by cells: the places of the cells that a point of the main volume is in, faces included.
struct Cells {
  Cells(const GridView& main, int cell_voxels, CellOrder cell_order) : order(cell_order) {
    const ValueRangeGrid ranges = build_value_ranges(main, cell_voxels, order);
    std::copy_n(ranges.cells, 3, n);
    edge = ranges.cell_voxels;
    places = ranges.ranges.size();
  }

  std::size_t place(const int (&at)[3]) const {
    if (order == CellOrder::kRows) return (std::size_t(at[2]) * n[1] + at[1]) * n[0] + at[0];
    const int cubes[2] = {(n[0] + 7) / 8, (n[1] + 7) / 8};
    const std::size_t cube = (std::size_t(at[2] / 8) * cubes[1] + at[1] / 8) * cubes[0] + at[0] / 8;
    return cube * 512 + (at[2] % 8 * 8 + at[1] % 8) * 8 + at[0] % 8;
  }

  template <class Visit>
  void each_with(Vec3f p, Visit&& visit) const {
    int first[3], last[3];
    for (int a = 0; a < 3; ++a) {
      last[a] = std::clamp(static_cast<int>(std::floor(p[a] / edge)), 0, n[a] - 1);
      const bool on_face = last[a] > 0 && p[a] == static_cast<float>(last[a] * edge);
      first[a] = last[a] - on_face;
    }
    for (int k = first[2]; k <= last[2]; ++k)
      for (int j = first[1]; j <= last[1]; ++j)
        for (int i = first[0]; i <= last[0]; ++i) visit(place({i, j, k}));
  }

  CellOrder order;
  int n[3], edge;
  std::size_t places;
};

/// Points of the main volume's domain; many on faces, edges and corners of cells and of the domain.
Vec3f point_of(const Volume& main, int edge, Rng& rng, int n) {
  Vec3f p = test::random_point(main, rng);
  for (int a = 0; a < 3; ++a) {
    if (n % 3 == 0 && (n >> (3 + a) & 1)) p[a] = std::round(std::max(p[a], 0.0f) / edge) * edge;
    if (n % 7 == 0 && (n >> (6 + a) & 1)) p[a] = n & 64 ? -0.5f : main.size[a] - 0.5f;
    p[a] = std::min(p[a], main.size[a] - 0.5f);
  }
  return p;
}

/// Where the look-up is. (On the same grid at p_index itself: its ranges know of no rounding on a way through
/// space.)
Vec3f on_proxy(const GridView& main, const GridView& proxy, Vec3f p_index) {
  if (std::equal(main.size, main.size + 3, proxy.size) &&
      main.world_from_index.column_x == proxy.world_from_index.column_x &&
      main.world_from_index.column_y == proxy.world_from_index.column_y &&
      main.world_from_index.translation == proxy.world_from_index.translation)
    return p_index;
  return proxy.index_from_world.point(main.world_from_index.point(p_index));
}

/// Checks one pair of volumes; returns how many look-ups there were.
int expect_ranges_hold(const Volume& main_volume, const Volume& proxy_volume, int edge, CellOrder order,
                       int draws, std::uint64_t seed) {
  const GridView main = make_grid_view(main_volume), proxy = make_grid_view(proxy_volume);
  const Cells cells(main, edge, order);
  const std::vector<ValueRange> ranges = value_ranges_over(main, edge, order, proxy);
  EXPECT_EQ(ranges.size(), cells.places);
  Rng rng(seed, 0, 0, 1);
  int inside = 0;
  for (int n = 0; n < draws; ++n) {
    const Vec3f p = point_of(main_volume, cells.edge, rng, n), q = on_proxy(main, proxy, p);
    if (!proxy.index_box().contains(q)) continue;
    const float v = sample_trilinear(proxy, q);
    if (std::isnan(v)) continue;
    cells.each_with(p, [&](std::size_t place) {
      ++inside;
      EXPECT_LE(ranges[place].lower, v) << p.x << " " << p.y << " " << p.z;
      EXPECT_GE(ranges[place].upper, v) << p.x << " " << p.y << " " << p.z;
    });
    if (testing::Test::HasFailure()) break;
  }
  return inside;
}

int expect_labels_hold(const Volume& main_volume, const Volume& label_volume, int edge, CellOrder order,
                       int draws, std::uint64_t seed) {
  const GridView main = make_grid_view(main_volume), labels = make_grid_view(label_volume);
  const Cells cells(main, edge, order);
  const LabelSets sets = label_sets_over(main, edge, order, labels);
  const LabelSets smooth = label_sets_over(main, edge, order, labels, Outline::kSmooth);
  const std::vector<std::uint8_t> leads = label_leads(labels);
  EXPECT_EQ(sets.set_of_cell.size(), cells.places);
  Rng rng(seed, 0, 0, 2);
  int inside = 0;
  for (int n = 0; n < draws; ++n) {
    const Vec3f p = point_of(main_volume, cells.edge, rng, n), q = on_proxy(main, labels, p);
    if (!labels.index_box().contains(q)) continue;
    const float nearest = sample_nearest(labels, q), voted = sample_outline(labels, leads.data(), q);
    cells.each_with(p, [&](std::size_t place) {
      inside += !std::isnan(nearest);
      const auto set = sets.set(sets.set_of_cell[place]), voters = smooth.set(smooth.set_of_cell[place]);
      EXPECT_TRUE(std::isnan(nearest) || std::binary_search(set.begin(), set.end(), nearest)) << nearest;
      EXPECT_TRUE(std::isnan(voted) || std::binary_search(voters.begin(), voters.end(), voted)) << voted;
    });
    if (testing::Test::HasFailure()) break;
  }
  return inside;
}

/// check(main, proxy, edge, order, draws, seed) for many sizes and placements of a volume of T.
template <class T, class Check>
int check_all(Check&& check) {
  const Size3 sizes[] = {{1, 1, 1}, {33, 20, 1}, {3, 5, 7}, {33, 20, 17}};
  int inside = 0;
  std::uint64_t seed = 100;
  for (const Size3& main_size : sizes) {
    const Volume main = noise_volume<std::uint8_t>(main_size, 5, kMain);
    for (const Size3& size : sizes)
      for (const Placement& place : proxy_places()) {
        const CellOrder order = ++seed % 2 ? CellOrder::kRows : CellOrder::kCubes;
        const int edge = std::array{1, 2, 3, 8}[seed / 2 % 4];
        inside += check(main, noise_volume<T>(size, seed, place), edge, order, 1500, seed);
      }
  }
  return inside;
}

template <class T>
class CellRanges : public testing::Test {};
using VoxelTypes =
    testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t, float, double>;
TYPED_TEST_SUITE(CellRanges, VoxelTypes);

TYPED_TEST(CellRanges, HoldEveryLookUp) {
  EXPECT_GT(check_all<TypeParam>(expect_ranges_hold), 30000);
  const Volume main = noise_volume<std::uint8_t>({33, 20, 17}, 5, kMain);
  int inside = 0;
  for (const Placement& place : proxy_places())
    inside += expect_ranges_hold(main, noise_volume<TypeParam>({33, 20, 17}, 9, place), 2, CellOrder::kCubes,
                                 40000, 9);
  EXPECT_GT(inside, 100000);
}

TYPED_TEST(CellRanges, OnTheOwnGridAreTheOwn) {
  for (const Size3& size : {Size3{33, 20, 17}, Size3{1, 1, 1}, Size3{5, 9, 1}})
    for (const CellOrder order : {CellOrder::kRows, CellOrder::kCubes}) {
      const Volume volume = noise_volume<TypeParam>(size, 7, kMain);
      const Volume main = noise_volume<std::uint8_t>(size, 8, kMain);
      const auto own = build_value_ranges(make_grid_view(volume), 3, order).ranges;
      const auto over = value_ranges_over(make_grid_view(main), 3, order, make_grid_view(volume));
      ASSERT_EQ(own.size(), over.size());
      EXPECT_EQ(std::memcmp(own.data(), over.data(), own.size() * sizeof(ValueRange)), 0);
    }
}

TYPED_TEST(CellRanges, LabelsHoldEveryLookUp) {
  EXPECT_GT(check_all<TypeParam>(expect_labels_hold), 30000);
  const Volume main = noise_volume<std::uint8_t>({33, 20, 17}, 5, kMain);
  int inside = 0;
  for (const Placement& place : proxy_places())
    inside += expect_labels_hold(main, noise_volume<TypeParam>({33, 20, 17}, 9, place), 2, CellOrder::kCubes,
                                 40000, 9);
  EXPECT_GT(inside, 100000);
}

TEST(CellRangesOver, HoldAfterATripThroughSpace) {
  // The renderer starts from a point in space and rounds once for each grid.
  const Volume main_volume = noise_volume<std::uint8_t>({33, 20, 17}, 5, kMain);
  const GridView main = make_grid_view(main_volume);
  const Cells cells(main, 2, CellOrder::kRows);
  for (const Placement& place : proxy_places()) {
    const Volume proxy_volume = noise_volume<float>({33, 20, 17}, 9, place);
    const GridView proxy = make_grid_view(proxy_volume);
    const auto ranges = value_ranges_over(main, 2, CellOrder::kRows, proxy);
    Rng rng(4, 0, 0, 0);
    for (int n = 0; n < 50000; ++n) {
      const Vec3f world = main.world_from_index.point(point_of(main_volume, 2, rng, n));
      const Vec3f p = main.index_from_world.point(world), q = proxy.index_from_world.point(world);
      if (!proxy.index_box().contains(q) || !main.index_box().contains(p)) continue;
      const float v = sample_trilinear(proxy, q);
      cells.each_with(p, [&](std::size_t at) {
        ASSERT_LE(ranges[at].lower, v);
        ASSERT_GE(ranges[at].upper, v);
      });
    }
  }
}

TEST(CellRangesOver, OutsideIsEmpty) {
  const Volume main = noise_volume<std::uint8_t>({33, 20, 17}, 5, kMain);
  const Volume away = noise_volume<std::uint8_t>({33, 20, 17}, 6, proxy_places()[6]);
  for (const ValueRange& range :
       value_ranges_over(make_grid_view(main), 2, CellOrder::kCubes, make_grid_view(away)))
    ASSERT_TRUE(range.empty());
  const LabelSets sets = label_sets_over(make_grid_view(main), 2, CellOrder::kCubes, make_grid_view(away));
  EXPECT_EQ(sets.set_count(), 1u);
  EXPECT_TRUE(sets.set(0).empty());
  for (const std::uint32_t set : sets.set_of_cell) ASSERT_EQ(set, 0u);
}

TEST(CellRangesOver, AreTight) {
  // A proxy of two values, apart at x = 20 mm: cells further away than a few voxels have one value.
  const Volume main_volume = noise_volume<std::uint8_t>({40, 20, 20}, 5);
  const Placement place{{0.5, 0.5, 0.5}, {-1.3, -0.9, -2.2}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
  const Volume proxy = make_volume<float>(
      {90, 60, 60}, [](auto i, auto, auto) { return i * 0.5 - 1.3 < 20 ? 0.1f : 7.3f; }, place);
  const GridView main = make_grid_view(main_volume);
  const Cells cells(main, 2, CellOrder::kRows);
  const auto ranges = value_ranges_over(main, 2, CellOrder::kRows, make_grid_view(proxy));
  for (int i = 0; i < cells.n[0]; ++i) {
    const ValueRange range = ranges[cells.place({i, 3, 3})];
    const double begin = i * 2 - (i == 0 ? 0.5 : 0.0), end = begin + 2.5;
    if (end < 19) {
      EXPECT_EQ(range.upper, 0.1f) << i;
    }
    if (begin > 21) {
      EXPECT_EQ(range.lower, 7.3f) << i;
    }
    if (begin < 19.6 && end > 20.4) {
      EXPECT_LT(range.lower, range.upper) << i;
    }
  }
}

TEST(CellRangesOver, ReachNoFurtherThanTheBoxAroundTheCell) {
  // Value = column of the proxy, so that ranges tell which columns were counted.
  const Volume main_volume = noise_volume<std::uint8_t>({24, 24, 24}, 5);
  Placement place;
  place.direction = turned(0.7);
  place.origin_mm = {3, -2, 1};
  const Volume proxy_volume = make_volume<std::int16_t>(
      {40, 40, 40}, [](auto i, auto, auto) { return i; }, place);
  const GridView main = make_grid_view(main_volume), proxy = make_grid_view(proxy_volume);
  const Cells cells(main, 2, CellOrder::kCubes);
  const auto ranges = value_ranges_over(main, 2, CellOrder::kCubes, proxy);
  int counted = 0;
  for (int k = 1; k + 1 < cells.n[2]; ++k)
    for (int j = 1; j + 1 < cells.n[1]; ++j)
      for (int i = 1; i + 1 < cells.n[0]; ++i) {
        float lower = 1e9f, upper = -1e9f;
        bool within = true;
        for (int corner = 0; corner < 8; ++corner) {
          const Vec3f p(2.0f * (i + (corner & 1)), 2.0f * (j + (corner >> 1 & 1)),
                        2.0f * (k + (corner >> 2)));
          const Vec3f q = on_proxy(main, proxy, p);
          within = within && proxy.index_box().contains(q);
          lower = std::min(lower, q.x);
          upper = std::max(upper, q.x);
        }
        if (!within) continue;
        ++counted;
        const ValueRange range = ranges[cells.place({i, j, k})];
        ASSERT_GE(range.lower, std::floor(lower - 1e-4f) - 1e-3f);
        ASSERT_LE(range.upper, std::ceil(upper + 1e-4f) + 1e-3f);
      }
  EXPECT_GT(counted, 100);
}

TEST(CellRangesOver, NaNIsNotCounted) {
  const Volume main = noise_volume<std::uint8_t>({9, 9, 9}, 5);
  Placement place;
  place.origin_mm = {0.25, 0, 0};
  const Volume proxy = make_volume<float>(
      {12, 12, 12}, [](auto i, auto j, auto k) { return (i + j + k) % 3 == 0 ? kNaN : -2.0f; }, place);
  for (const ValueRange& range :
       value_ranges_over(make_grid_view(main), 4, CellOrder::kRows, make_grid_view(proxy))) {
    EXPECT_EQ(range.lower, -2.0f);
    EXPECT_EQ(range.upper, -2.0f);
  }
  const LabelSets sets = label_sets_over(make_grid_view(main), 4, CellOrder::kRows, make_grid_view(proxy));
  EXPECT_EQ(sets.labels, std::vector<float>{-2.0f});
}

template <class T>
void expect_exact_labels(Size3 size, int edge, int labels) {
  Rng rng(77, 0, 0, 0);
  const Volume volume = make_volume<T>(
      size, [&](auto, auto, auto) { return std::floor(rng.next() * labels); }, kMain);
  const GridView grid = make_grid_view(volume);
  const Cells cells(grid, edge, CellOrder::kCubes);
  const LabelSets sets = label_sets_over(grid, edge, CellOrder::kCubes, grid);
  const LabelSets smooth = label_sets_over(grid, edge, CellOrder::kCubes, grid, Outline::kSmooth);
  EXPECT_EQ(smooth.set_of_cell, sets.set_of_cell);
  EXPECT_EQ(smooth.labels, sets.labels);
  for (int k = 0; k < cells.n[2]; ++k)
    for (int j = 0; j < cells.n[1]; ++j)
      for (int i = 0; i < cells.n[0]; ++i) {
        const std::int64_t first[3] = {i * edge, j * edge, k * edge};
        std::set<float> expected;
        for (std::int64_t z = first[2]; z <= std::min(first[2] + edge, size[2] - 1); ++z)
          for (std::int64_t y = first[1]; y <= std::min(first[1] + edge, size[1] - 1); ++y)
            for (std::int64_t x = first[0]; x <= std::min(first[0] + edge, size[0] - 1); ++x)
              expected.insert(test::voxel_at<T>(volume, x, y, z));
        const auto found = sets.set(sets.set_of_cell[cells.place({i, j, k})]);
        ASSERT_EQ(std::vector<float>(expected.begin(), expected.end()),
                  std::vector<float>(found.begin(), found.end()));
      }
}

TEST(LabelSetsOver, OnTheOwnGridAreExact) {
  expect_exact_labels<std::uint8_t>({33, 20, 17}, 2, 3);
  expect_exact_labels<std::uint16_t>({33, 20, 17}, 4, 5000);
  expect_exact_labels<std::uint32_t>({17, 9, 10}, 3, 100000);
  expect_exact_labels<std::int32_t>({17, 9, 1}, 1, 7);
  expect_exact_labels<float>({20, 20, 20}, 19, 4);
  expect_exact_labels<std::uint16_t>({30, 30, 30}, 29, 60000);
}

TEST(LabelSetsOver, EqualSetsAreStoredOnce) {
  const Volume volume = make_volume<std::int16_t>({64, 64, 64}, [](auto i, auto, auto) { return i < 21; });
  const GridView grid = make_grid_view(volume);
  const LabelSets sets = label_sets_over(grid, 2, CellOrder::kRows, grid);
  EXPECT_EQ(sets.labels, (std::vector<float>{1, 0, 1, 0}));  // {1}, {0, 1}, {0}, in the order of the cells
  EXPECT_EQ(sets.begin, (std::vector<std::uint32_t>{0, 0, 1, 3, 4}));
}

TEST(LabelSetsOver, AreTheSameForAnyThreadCount) {
  Rng rng(6, 0, 0, 0);
  const Volume volume = make_volume<std::uint16_t>(
      {40, 33, 70}, [&](auto i, auto, auto k) { return std::floor(rng.next() * 300) + i / 7 * 100 + k; },
      proxy_places()[4]);
  const Volume main = noise_volume<std::uint8_t>({40, 33, 29}, 26, kMain);
  for (const CellOrder order : {CellOrder::kRows, CellOrder::kCubes}) {
    const auto build = [&](int threads) {
      const ThreadLimit limit(threads);
      return label_sets_over(make_grid_view(main), 2, order, make_grid_view(volume));
    };
    const LabelSets one = build(1), five = build(5);
    EXPECT_GT(one.set_count(), 100u);
    EXPECT_EQ(one.set_of_cell, five.set_of_cell);
    EXPECT_EQ(one.begin, five.begin);
    EXPECT_EQ(one.labels, five.labels);
  }
}

}  // namespace
}  // namespace voxlume
