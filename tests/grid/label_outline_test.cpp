#include "grid/label_outline.h"

#include <gtest/gtest.h>

#include <functional>

#include "grid/label_surface.h"
#include "support/volumes.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::Placement;
using test::Size3;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A volume of labels and its leads.
struct Labels {
  explicit Labels(Volume v) : volume(std::move(v)), grid(make_grid_view(volume)), leads(label_leads(grid)) {}

  float at(Vec3f p) const { return sample_outline(grid, leads.data(), p); }
  float voxel(int i, int j, int k) const {
    return sample_nearest(grid, {static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)});
  }

  Volume volume;
  GridView grid;
  std::vector<std::uint8_t> leads;
};

/// NaN is a label here.
bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

Vec3d random_unit(Rng& rng) {
  for (;;) {
    const Vec3d v(2 * rng.next() - 1, 2 * rng.next() - 1, 2 * rng.next() - 1);
    if (length(v) > 0.1 && length(v) <= 1) return normalize(v);
  }
}

Affined placed(const Placement& place) {
  return world_from_index(make_volume<std::uint8_t>(
      {1, 1, 1}, [](auto, auto, auto) { return 0; }, place));
}

/// Labels 2 where depth(LPS point) > 0, else 1.
template <class Depth>
Labels solid(Size3 size, Depth&& depth, const Placement& place = {}) {
  const Affined world = placed(place);
  return Labels(make_volume<std::uint8_t>(
      size, [&](auto i, auto j, auto k) { return depth(world.point(Vec3d(i, j, k))) > 0 ? 2 : 1; }, place));
}

/// How far from a true surface the labels end, in mm.
struct Distances {
  double squares = 0, sum = 0, most = 0;
  int count = 0;

  double rms() const { return std::sqrt(squares / count); }
  double mean() const { return sum / count; }
  double spread() const { return std::sqrt(std::max(squares / count - mean() * mean(), 0.0)); }

  /// Every end of label 2 within reach_mm along the normal counts.
  void add(const std::function<float(Vec3d)>& label_at, Vec3d p, Vec3d outward, double reach_mm) {
    constexpr int kSteps = 200;
    bool inside = true;
    for (int n = -kSteps; n <= kSteps; ++n) {
      const double off_mm = reach_mm * n / kSteps;
      const bool now = label_at(p + outward * off_mm) == 2;
      if (now != inside) {
        squares += off_mm * off_mm;
        sum += off_mm;
        most = std::max(most, std::abs(off_mm));
        ++count;
      }
      inside = now;
    }
    EXPECT_FALSE(inside);
  }
};

struct Both {
  Distances smooth, voxels;

  void add(const Labels& labels, Vec3d p_world, Vec3d outward, double reach_mm) {
    const auto index = [&](Vec3d p) { return labels.grid.index_from_world.point(Vec3f(p)); };
    smooth.add([&](Vec3d p) { return labels.at(index(p)); }, p_world, outward, reach_mm);
    voxels.add([&](Vec3d p) { return sample_nearest(labels.grid, index(p)); }, p_world, outward, reach_mm);
  }
};

Both distances_of_plane(Vec3d outward, const Placement& place, Rng& rng) {
  const Affined world = placed(place);
  const Vec3d center = world.point(Vec3d(20 + rng.next(), 20 + rng.next(), 20 + rng.next()));
  const double voxel_mm = std::cbrt(place.spacing_mm[0] * place.spacing_mm[1] * place.spacing_mm[2]);
  const double least_mm = std::min({place.spacing_mm[0], place.spacing_mm[1], place.spacing_mm[2]});
  const double most_mm = std::max({place.spacing_mm[0], place.spacing_mm[1], place.spacing_mm[2]});
  const Labels labels = solid(
      {41, 41, 41}, [&](Vec3d p) { return -dot(outward, p - center); }, place);
  Both both;
  for (int n = 0; n < 150; ++n) {
    const Vec3d to = random_unit(rng) * (10 * least_mm * rng.next());
    both.add(labels, center + to - outward * dot(outward, to), outward, 1.5 * std::max(most_mm, voxel_mm));
  }
  return both;
}

TEST(LabelOutline, OfAPlaneIsThePlane) {
  Rng rng(1, 0, 0, 0);
  double smooth = 0, voxels = 0, most = 0;
  constexpr int kPlanes = 16;
  for (int n = 0; n < kPlanes; ++n) {
    const Both both = distances_of_plane(random_unit(rng), {}, rng);
    smooth += both.smooth.rms() / kPlanes;
    voxels += both.voxels.rms() / kPlanes;
    most = std::max(most, both.smooth.most);
  }
  EXPECT_LT(smooth, 0.09);
  EXPECT_GT(voxels, 0.27);
  EXPECT_LT(most, 0.35);
}

TEST(LabelOutline, OfAGentleSlopeHasNoStairs) {
  Rng rng(2, 0, 0, 0);
  for (const Vec3d& normal : {Vec3d(0.2, 0, 1), Vec3d(0.125, 0.03, 1), Vec3d(1, 0.1, -0.1)}) {
    const Both both = distances_of_plane(normalize(normal), {}, rng);
    EXPECT_LT(both.smooth.rms(), 0.15);
    EXPECT_LT(both.smooth.most, 0.25);
    EXPECT_GT(both.voxels.rms(), 0.25);
  }
}

TEST(LabelOutline, OfAPlaneInVoxelsOfAnyShape) {
  Rng rng(3, 0, 0, 0);
  for (const Placement& place : test::placements()) {
    double smooth = 0, voxels = 0;
    for (int n = 0; n < 8; ++n) {
      const Both both = distances_of_plane(random_unit(rng), place, rng);
      smooth += both.smooth.rms();
      voxels += both.voxels.rms();
    }
    EXPECT_LT(smooth, 0.5 * voxels);
  }
}

TEST(LabelOutline, OfABallIsRound) {
  for (const double radius : {6.2, 10.4, 15.1}) {
    const Vec3d center(18.6, 19.2, 19.1);
    const Labels labels = solid({39, 39, 39}, [&](Vec3d p) { return radius - length(p - center); });
    Both both;
    Rng rng(4, 0, 0, 0);
    for (int n = 0; n < 3000; ++n) {
      const Vec3d outward = random_unit(rng);
      both.add(labels, center + outward * radius, outward, 1.5);
    }
    // Smoothing draws a ball in, the more the smaller it is.
    EXPECT_LT(both.smooth.spread(), radius > 7 ? 0.1 : 0.16) << radius;
    EXPECT_GT(both.voxels.spread(), 0.27);
    EXPECT_NEAR(both.smooth.mean(), 0, 1.8 / radius);
    EXPECT_LT(both.smooth.most, 0.6);
  }
}

TEST(LabelOutline, NormalsFaceOutOnTheOutline) {
  const Vec3d center(15.3, 14.9, 15.2);
  const Labels labels = solid({31, 31, 31}, [&](Vec3d p) { return 9 - length(p - center); });
  Rng rng(5, 0, 0, 0);
  for (int n = 0; n < 5000; ++n) {
    const Vec3d outward = random_unit(rng);
    // The last point of the label on the way out.
    double r = 7;
    while (labels.at(Vec3f(center + outward * (r + 0.01))) == 2) r += 0.01;
    const Vec3f p(center + outward * r);
    const Vec3f normal = label_normal(labels.grid, p, labels.at(p));
    ASSERT_GT(length(normal), 0.85f);
    ASSERT_GT(dot(Vec3d(normal) / length(normal), outward), 0.96);
  }
}

template <class T>
Labels random_labels(Size3 size, int labels, double scale, double holes, std::uint64_t seed) {
  Rng rng(seed, 0, 0, 0);
  return Labels(make_volume<T>(size, [&](auto i, auto j, auto k) -> double {
    if (rng.next() < holes) return kNaN;
    const auto block = static_cast<std::uint32_t>(i / 3 + 7 * (j / 4) + 31 * (k / 2));
    const double u = rng.next();
    return scale *
           (u < 0.7 ? block * 2654435761u % static_cast<std::uint32_t>(labels) : std::floor(u * labels));
  }));
}

std::vector<Labels> various() {
  std::vector<Labels> out;
  const Size3 size{15, 13, 11};
  out.push_back(random_labels<std::uint8_t>(size, 3, 1, 0, 10));
  out.push_back(random_labels<std::int8_t>(size, 100, -1, 0, 11));
  out.push_back(random_labels<std::uint16_t>(size, 700, 90, 0, 12));
  out.push_back(random_labels<std::int16_t>(size, 4, -8000, 0, 13));
  out.push_back(random_labels<std::uint32_t>(size, 5, 2000000, 0, 14));
  out.push_back(random_labels<std::int32_t>(size, 5000, -1600, 0, 15));
  out.push_back(random_labels<float>(size, 3, -4000000, 0.2, 16));
  out.push_back(random_labels<double>(size, 3, 1, 0.2, 17));
  out.push_back(random_labels<std::uint8_t>({1, 9, 1}, 2, 1, 0, 18));
  out.push_back(random_labels<std::uint8_t>({2, 1, 30}, 2, 1, 0, 19));
  return out;
}

TEST(LabelOutline, EveryCenterKeepsItsLabel) {
  for (const Labels& labels : various())
    for (int k = 0; k < labels.grid.size[2]; ++k)
      for (int j = 0; j < labels.grid.size[1]; ++j)
        for (int i = 0; i < labels.grid.size[0]; ++i) {
          const Vec3f p(Vec3d(i, j, k));
          ASSERT_TRUE(same(labels.at(p), labels.voxel(i, j, k))) << i << " " << j << " " << k;
        }
}

TEST(LabelOutline, EveryPointHasALabelFromRoundAbout) {
  Rng rng(20, 0, 0, 0);
  for (const Labels& labels : various())
    for (int n = 0; n < 20000; ++n) {
      const Vec3f p = test::random_point(labels.volume, rng);
      const float label = labels.at(p);
      // The shortcut within a label changes nothing.
      ASSERT_TRUE(same(label, voted_label(labels.grid, labels.leads.data(), p)));
      bool found = false;
      for (int corner = 0; corner < 8; ++corner) {
        int at[3];
        for (int a = 0; a < 3; ++a) {
          const int low = static_cast<int>(std::floor(p[a])) + (corner >> a & 1);
          at[a] = std::clamp(low, 0, labels.grid.size[a] - 1);
        }
        found |= same(label, labels.voxel(at[0], at[1], at[2]));
      }
      ASSERT_TRUE(found) << label;
    }
}

TEST(LabelOutline, DoesNotDependOnWhatLabelsAreCalled) {
  const Size3 size{14, 12, 10};
  const Labels small = random_labels<std::uint8_t>(size, 6, 1, 0, 21);
  const Labels large = random_labels<std::int32_t>(size, 6, 1600000, 0, 21);
  const Labels real = random_labels<double>(size, 6, 70000, 0, 21);
  EXPECT_EQ(small.leads, large.leads);
  EXPECT_EQ(small.leads, real.leads);
  Rng rng(22, 0, 0, 0);
  for (int n = 0; n < 20000; ++n) {
    const Vec3f p = test::random_point(small.volume, rng);
    ASSERT_EQ(1600000 * small.at(p), large.at(p));
    ASSERT_EQ(70000 * small.at(p), real.at(p));
  }
}

TEST(LabelOutline, WithinALabelItIsAllThatLabel) {
  const Labels labels(
      make_volume<std::int16_t>({20, 8, 8}, [](auto i, auto, auto) { return i < 10 ? -3 : 900; }));
  Rng rng(23, 0, 0, 0);
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 8; ++j)
      EXPECT_EQ(labels.leads[static_cast<std::size_t>(20 * j + i)] == 0, i != 9 && i != 10);
  for (int n = 0; n < 5000; ++n) {
    const Vec3f p = test::random_point(labels.volume, rng);
    // The border of a box is where its voxels' faces are.
    if (std::abs(p.x - 9.5f) < 1e-5f) continue;
    ASSERT_EQ(labels.at(p), p.x < 9.5f ? -3 : 900) << p.x;
  }
}

/// Label 2's volume over that of its voxels.
double volume_share(const Labels& labels, std::uint64_t seed) {
  Rng rng(seed, 0, 0, 0);
  int smooth = 0, voxels = 0;
  for (int n = 0; n < 400000; ++n) {
    const Vec3f p = test::random_point(labels.volume, rng);
    smooth += labels.at(p) == 2;
    voxels += sample_nearest(labels.grid, p) == 2;
  }
  return static_cast<double>(smooth) / voxels;
}

TEST(LabelOutline, ThinPartsKeepAboutTheirVolume) {
  const Size3 size{14, 14, 14};
  const auto box = [&](int x, int y, int z) {
    return Labels(make_volume<std::uint8_t>(size, [=](auto i, auto j, auto k) {
      return i >= 6 && i < 6 + x && j >= 6 && j < 6 + y && k >= 6 && k < 6 + z ? 2 : 1;
    }));
  };
  for (const int n : {1, 2, 3}) {
    EXPECT_NEAR(volume_share(box(n, 20, 20), 30), 1, 0.4) << "plate of " << n;
    EXPECT_NEAR(volume_share(box(n, n, 20), 31), 1, 0.25) << "bar of " << n;
    EXPECT_NEAR(volume_share(box(n, n, n), 32), 1, 0.35) << "cube of " << n;
  }
  // A line of single voxels between two other labels gets thicker, by a quarter of its width.
  const Labels between(make_volume<std::uint8_t>(size, [](auto, auto j, auto k) {
    return j == 7 && k == 7 ? 2 : k < 7 ? 1 : 3;
  }));
  const double line = volume_share(between, 33);
  EXPECT_GT(line, 0.7);
  EXPECT_LT(line, 1.56);
  // Along a diagonal, voxels that meet at their edges stay joined.
  const Labels diagonal(
      make_volume<std::uint8_t>(size, [](auto i, auto j, auto k) { return i == j && k == 7 ? 2 : 1; }));
  for (float t = 1; t < 12; t += 0.01f) ASSERT_EQ(diagonal.at({t, t, 7}), 2) << t;
}

TEST(LabelOutline, WhereTwoLabelsMeetOnASurfaceThereIsNoGroove) {
  // Labels 2 and 3 side by side, below a flat top at k = 9.5.
  const Labels labels(make_volume<std::uint8_t>({20, 20, 20}, [](auto i, auto, auto k) {
    return k > 9 ? 1 : i < 10 ? 2 : 3;
  }));
  for (float x = 2; x < 18; x += 0.05f) {
    EXPECT_EQ(labels.at({x, 10, 9.6f}), 1) << x;
    EXPECT_NE(labels.at({x, 10, 9.4f}), 1) << x;
  }
}

TEST(LabelOutline, ThreeLabelsMeetInALine) {
  // Sectors about (15.2, 14.7).
  const auto sector = [](double x, double y) {
    return std::floor((std::atan2(y - 14.7 - 0.2 * (x - 15.2), x - 15.2) / 6.283185307 + 1) * 3);
  };
  const Labels labels(
      make_volume<std::uint8_t>({30, 30, 5}, [&](auto i, auto j, auto) { return sector(i, j); }));
  Rng rng(34, 0, 0, 0);
  int smooth = 0, voxels = 0;
  for (int n = 0; n < 100000; ++n) {
    const Vec3f p = test::random_point(labels.volume, rng);
    smooth += labels.at(p) != static_cast<float>(sector(p.x, p.y));
    voxels += sample_nearest(labels.grid, p) != static_cast<float>(sector(p.x, p.y));
  }
  EXPECT_LT(2 * smooth, voxels);
}

}  // namespace
}  // namespace voxlume
