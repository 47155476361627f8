#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "accel/majorant_view.h"
#include "support/random_direction.h"

namespace voxlume {
namespace {

using test::random_direction;

/// Cells whose majorant is their number, over a volume of a given size.
struct Cells {
  Cells(std::int32_t nx, std::int32_t ny, std::int32_t nz, std::int32_t cell_voxels) {
    const std::int32_t size[3] = {nx, ny, nz};
    for (int a = 0; a < 3; ++a) {
      view.cells[a] = std::max(1, (size[a] - 2 + cell_voxels) / cell_voxels);
      view.domain.lower[a] = -0.5f;
      view.domain.upper[a] = static_cast<float>(size[a]) - 0.5f;
    }
    view.cell_voxels = static_cast<float>(cell_voxels);
    numbers.resize(static_cast<std::size_t>(view.cells[0] * view.cells[1] * view.cells[2]));
    std::iota(numbers.begin(), numbers.end(), 0.0f);
    view.mu_maj = numbers.data();
  }
  Box3d box(int number) const {
    const int at[3] = {number % view.cells[0], number / view.cells[0] % view.cells[1],
                       number / view.cells[0] / view.cells[1]};
    Box3d out;
    for (int a = 0; a < 3; ++a) {
      out.lower[a] = at[a] == 0 ? -0.5 : at[a] * static_cast<double>(view.cell_voxels);
      out.upper[a] = at[a] == view.cells[a] - 1 ? static_cast<double>(view.domain.upper[a])
                                                : (at[a] + 1) * static_cast<double>(view.cell_voxels);
    }
    return out;
  }
  std::vector<float> numbers;
  MajorantView view;
};

struct Ray {
  Vec3f origin, direction;
};

/// Walks the part of a ray inside the domain, checks what must hold of every walk and returns the length per
/// cell.
std::vector<double> walk(const Cells& cells, const Ray& ray, Interval<float> run) {
  std::vector<double> lengths(cells.numbers.size());
  // The rounding of a position: of the origin, of t, and of their sum.
  const double reach = length(Vec3d(ray.origin)) + run.t_far * length(Vec3d(ray.direction));
  const double rounding = 4 * 1.2e-7 * (reach + 1);
  MacrocellWalk w(cells.view, ray.origin, ray.direction, run.t_near, run.t_far);
  MajorantSegment segment;
  float t = run.t_near;
  int count = 0;
  while (w.next(segment)) {
    EXPECT_EQ(segment.t_near, t);
    EXPECT_GE(segment.t_far, segment.t_near);
    t = segment.t_far;
    const int number = static_cast<int>(segment.mu_maj);
    const Box3d box = cells.box(number);
    EXPECT_EQ(Box3d(Vec3d(segment.cell.lower), Vec3d(segment.cell.upper)), box);
    for (const float at : {segment.t_near, 0.5f * (segment.t_near + segment.t_far), segment.t_far}) {
      const Vec3d p = Vec3d(ray.origin) + Vec3d(ray.direction) * static_cast<double>(at);
      for (int a = 0; a < 3 && segment.t_far > segment.t_near; ++a) {
        EXPECT_GE(p[a], box.lower[a] - rounding);
        EXPECT_LE(p[a], box.upper[a] + rounding);
      }
    }
    lengths[static_cast<std::size_t>(number)] += static_cast<double>(segment.t_far) - segment.t_near;
    if (++count > cells.view.cells[0] + cells.view.cells[1] + cells.view.cells[2] + 4) {
      ADD_FAILURE() << "the walk does not end";
      break;
    }
  }
  EXPECT_EQ(t, std::max(run.t_near, run.t_far));
  return lengths;
}

Interval<float> inside(const Cells& cells, const Ray& ray) {
  return clip_ray(cells.view.domain, ray.origin, ray.direction, 0.0f, std::numeric_limits<float>::infinity());
}

/// Length of a ray in each cell by intersecting it with every cell's box.
std::vector<double> lengths_of(const Cells& cells, const Ray& ray, Interval<float> run) {
  std::vector<double> out;
  for (std::size_t n = 0; n < cells.numbers.size(); ++n) {
    const Box3d box = cells.box(static_cast<int>(n));
    double t_near = run.t_near, t_far = run.t_far;
    for (int a = 0; a < 3; ++a) {
      const double o = ray.origin[a], d = ray.direction[a];
      if (d == 0) {
        if (o < box.lower[a] || o > box.upper[a]) t_far = t_near;
        continue;
      }
      t_near = std::max(t_near, std::min((box.lower[a] - o) / d, (box.upper[a] - o) / d));
      t_far = std::min(t_far, std::max((box.lower[a] - o) / d, (box.upper[a] - o) / d));
    }
    out.push_back(std::max(0.0, t_far - t_near));
  }
  return out;
}

std::vector<Cells> many_cells() {
  std::vector<Cells> out;
  for (const int c : {1, 2, 3, 4, 8, 1000}) {
    out.emplace_back(1, 1, 1, c);
    out.emplace_back(3, 5, 7, c);
    out.emplace_back(9, 6, 1, c);
    out.emplace_back(1, 17, 4, c);
    out.emplace_back(13, 12, 14, c);
  }
  for (Cells& cells : out) cells.view.mu_maj = cells.numbers.data();
  return out;
}

TEST(Walk, LengthPerCellEqualsTheIntersections) {
  Rng rng(51, 0, 0, 0);
  for (const Cells& cells : many_cells()) {
    const Vec3f extent = cells.view.domain.extent();
    for (int n = 0; n < 1500 && !HasFailure(); ++n) {
      Ray ray;
      const Vec3f target = cells.view.domain.lower + extent * Vec3f(rng.next(), rng.next(), rng.next());
      ray.direction = random_direction(rng) * (0.1f + 2 * rng.next());
      if (n % 3 == 0) ray.direction[n / 3 % 3] = 0;  // parallel to a face
      ray.origin = n % 2 ? target : target - ray.direction * (50 * rng.next());
      Interval<float> run = inside(cells, ray);
      if (run.empty()) continue;
      if (n % 5 == 0) run.t_far = run.t_near + (run.t_far - run.t_near) * rng.next();
      const std::vector<double> walked = walk(cells, ray, run), expected = lengths_of(cells, ray, run);
      const double slope = min_component(max(max(Vec3d(ray.direction), -Vec3d(ray.direction)), Vec3d(1e-3)));
      const double rounding = 1e-6 * (1 + length(Vec3d(ray.origin)) + run.t_far) / slope;
      for (std::size_t i = 0; i < walked.size(); ++i)
        ASSERT_NEAR(walked[i], expected[i], rounding) << "cell " << i;
    }
  }
}

TEST(Walk, DegenerateRaysTileTheirInterval) {
  // Every combination of origins on corners, edges, faces, centres and outside with directions along axes and
  // diagonals.
  const float directions[] = {-1, 0, 1, -0.0f, 0.5f, 1e-20f, -1e-7f};
  for (const Cells& cells : many_cells()) {
    std::vector<float> coordinates[3];
    for (int a = 0; a < 3; ++a) {
      const float c = cells.view.cell_voxels, last = cells.view.domain.upper[a];
      for (const float x : {-0.5f, 0.0f, c, 2 * c, 0.3f * last, last}) coordinates[a].push_back(x);
    }
    for (const float x : coordinates[0])
      for (const float y : coordinates[1])
        for (const float z : coordinates[2])
          for (int d = 0; d < 343 && !HasFailure(); ++d) {
            const Ray ray{{x, y, z}, {directions[d % 7], directions[d / 7 % 7], directions[d / 49]}};
            if (!(length(ray.direction) > 0.1f)) continue;
            const Interval<float> run = inside(cells, ray);
            if (run.empty()) continue;
            walk(cells, ray, run);
          }
  }
}

TEST(Walk, DiagonalVisitsTheDiagonal) {
  const Cells cells(17, 17, 17, 4);
  for (const float sign : {1.0f, -1.0f}) {
    const float start = sign > 0 ? -0.5f : 16.5f;
    const Ray ray{Vec3f(start), Vec3f(sign)};
    const std::vector<double> lengths = walk(cells, ray, inside(cells, ray));
    for (int i = 0; i < 4; ++i)
      EXPECT_EQ(lengths[static_cast<std::size_t>(i * (1 + 4 + 16))], i == 0 || i == 3 ? 4.5 : 4.0);
  }
}

TEST(Walk, StartsInTheCellAhead) {
  const Cells cells(9, 5, 5, 4);
  for (const float sign : {1.0f, -1.0f}) {
    MacrocellWalk w(cells.view, {4, 1, 1}, {sign, 0, 0}, 0, 2);
    MajorantSegment segment;
    ASSERT_TRUE(w.next(segment));
    while (segment.t_far == segment.t_near) ASSERT_TRUE(w.next(segment));
    EXPECT_EQ(segment.mu_maj, sign > 0 ? 1.0f : 0.0f);
    EXPECT_EQ(segment.t_far, 2.0f);
  }
}

TEST(Walk, EmptyIntervalsHaveNoSegments) {
  const Cells cells(9, 5, 5, 4);
  MajorantSegment segment;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const auto& [a, b] :
       {std::pair{1.0f, 1.0f}, std::pair{2.0f, 1.0f}, std::pair{nan, 1.0f}, std::pair{0.0f, nan}}) {
    MacrocellWalk w(cells.view, {1, 1, 1}, {1, 0, 0}, a, b);
    EXPECT_FALSE(w.next(segment));
  }
}

TEST(Walk, TinyAndMeaninglessDirectionsEnd) {
  const Cells cells(9, 9, 9, 4);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float tiny : {1e-39f, -1e-39f, 1e-45f, -1e-45f, 1e-38f}) {
    // On a face, where the distance to it over the direction is 0 * infinity.
    for (const Ray& ray : {Ray{{-0.5f, 4, 4}, {1, tiny, 0}}, Ray{{4, -0.5f, 4}, {tiny, 1, tiny}},
                           Ray{{-0.5f, tiny > 0 ? 8.5f : -0.5f, 4}, {1, tiny, 0}}}) {
      const std::vector<double> lengths = walk(cells, ray, {0, 9});
      double total = 0;
      for (const double l : lengths) total += l;
      EXPECT_EQ(total, 9.0);
    }
  }
  for (const Ray& ray :
       {Ray{{nan, 1, 1}, {1, 0, 0}}, Ray{{1, 1, 1}, {nan, nan, nan}}, Ray{{nan, nan, nan}, {nan, 1, 1}}}) {
    MacrocellWalk w(cells.view, ray.origin, ray.direction, 0, 5);
    MajorantSegment segment;
    int count = 0;
    while (w.next(segment) && count < 100) ++count;
    EXPECT_LT(count, 100);
  }
}

TEST(Walk, RoundingAtTheBorderLosesNothing) {
  const Cells cells(9, 9, 9, 4);
  Rng rng(54, 0, 0, 0);
  for (int n = 0; n < 5000 && !HasFailure(); ++n) {
    Ray ray{{8 * rng.next(), 8 * rng.next(), 8 * rng.next()}, random_direction(rng)};
    if (n % 2) ray.origin[n / 2 % 3] = n % 4 > 1 ? 8.5f : -0.5f;  // grazing a face
    if (n % 2) ray.direction[n / 2 % 3] *= 1e-7f;
    Interval<float> run = inside(cells, ray);
    run.t_near = 0;
    run.t_far = std::nextafter(std::max(run.t_far, n % 2 ? 0.5f : 0.0f), 1e30f);
    walk(cells, ray, run);
  }
}

TEST(Walk, FarOriginsStillTile) {
  const Cells cells(64, 64, 64, 4);
  Rng rng(53, 0, 0, 0);
  for (int n = 0; n < 20000 && !HasFailure(); ++n) {
    const Vec3f target(63 * rng.next(), 63 * rng.next(), 63 * rng.next());
    Ray ray;
    ray.direction = random_direction(rng);
    ray.origin = target - ray.direction * std::pow(10.0f, 1 + 4 * rng.next());
    const Interval<float> run = inside(cells, ray);
    if (!run.empty()) walk(cells, ray, run);
  }
}

}  // namespace
}  // namespace voxlume
