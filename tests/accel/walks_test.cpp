// Walks of every structure over the same volumes and rays. walk_test.cpp looks closer at the uniform grid's.
#include <gtest/gtest.h>

#include "accel/accelerator.h"
#include "grid/sample.h"
#include "support/random_direction.h"
#include "support/transfers.h"
#include "support/volumes.h"

namespace voxlume {
namespace {

using test::random_direction;
using test::Size3;

struct Structure {
  const char* name;
  AcceleratorChoice choice;
};

std::ostream& operator<<(std::ostream& out, const Structure& s) { return out << s.name; }

Structure structure(const char* name, AcceleratorKind kind, HierarchyCosts costs = {},
                    OctreeThresholds thresholds = {}) {
  return {name, {kind, 0, costs, thresholds}};
}

/// A volume with empty, flat and noisy parts under a structure, and the majorants of its finest cells.
struct Medium {
  Medium(Size3 size, int cell_voxels, AcceleratorChoice choice)
      : volume(make(size)),
        grid(make_grid_view(volume)),
        function(test::mu_t_function({{50, 0}, {60, 0.01}, {100, 0.1}, {200, 4}})),
        accelerator(grid, with_cells(choice, cell_voxels)),
        finest(grid, cell_voxels) {
    accelerator.update(function);
    finest.update(function);
    view = accelerator.view();
    cells = finest.view();
  }
  static AcceleratorChoice with_cells(AcceleratorChoice choice, int cell_voxels) {
    choice.cell_voxels = cell_voxels;
    return choice;
  }
  static Volume make(Size3 size) {
    Rng rng(81, 0, 0, 0);
    return test::make_volume<std::uint8_t>(size, [&](auto i, auto j, auto k) {
      const float u = rng.next();
      if (2 * i > size[0] && 3 * j > size[1]) return 10.0f;
      if (2 * k > size[2]) return 80.0f;
      return u < 0.1f ? 200.0f : u < 0.5f ? 55.0f : 30.0f * u;
    });
  }
  /// The greatest majorant of the finest cells in `box`; at the border cells reach on.
  float majorant_over(const Box3f& box) const {
    std::int32_t first[3], last[3];
    for (int a = 0; a < 3; ++a) {
      first[a] = std::clamp(static_cast<std::int32_t>(std::floor(box.lower[a] / cells.cell_voxels + 0.01f)),
                            0, cells.cells[a] - 1);
      last[a] = std::clamp(static_cast<std::int32_t>(std::ceil(box.upper[a] / cells.cell_voxels - 0.01f)) - 1,
                           first[a], cells.cells[a] - 1);
    }
    float greatest = 0;
    for (std::int32_t k = first[2]; k <= last[2]; ++k)
      for (std::int32_t j = first[1]; j <= last[1]; ++j)
        for (std::int32_t i = first[0]; i <= last[0]; ++i)
          greatest =
              std::max(greatest, cells.mu_maj[(std::int64_t{k} * cells.cells[1] + j) * cells.cells[0] + i]);
    return greatest;
  }

  bool in_grid(const Box3f& box) const {
    for (int a = 0; a < 3; ++a)
      if (box.upper[a] <= 0 || box.lower[a] >= static_cast<float>(cells.cells[a]) * cells.cell_voxels)
        return false;
    return true;
  }

  Volume volume;
  GridView grid;
  TransferFunction function;
  Accelerator accelerator;
  MajorantGrid finest;
  AcceleratorView view;
  MajorantView cells;
};

struct Ray {
  Vec3f origin, direction;
};

class Walks : public testing::TestWithParam<Structure> {
 protected:
  /// Walks a ray and checks what must hold of every walk; returns where it ended.
  static float walk(const Medium& medium, const Ray& ray, float length_mm) {
    const double reach =
        length(Vec3d(ray.origin)) + static_cast<double>(length_mm) * length(Vec3d(ray.direction));
    const double rounding = 4 * 1.2e-7 * (reach + 1);
    float t = 0;
    int runs = 0;
    const int most_runs = medium.cells.cells[0] + medium.cells.cells[1] + medium.cells.cells[2] + 8;
    with_walk(medium.view, ray.origin, ray.direction, length_mm, [&](auto& w) {
      MajorantSegment s;
      while (!HasFatalFailure() && w.next(s)) {
        ASSERT_EQ(s.t_near, t);
        ASSERT_GE(s.t_far, s.t_near);
        t = s.t_far;
        ASSERT_LE(++runs, most_runs) << "the walk does not end";
        const float exact = medium.majorant_over(s.cell);
        ASSERT_GE(s.mu_maj, exact);
        // Cells around the grid continue the blocks beside them.
        if (medium.in_grid(s.cell)) {
          ASSERT_LE(s.mu_maj, exact * (1 + 1e-6f));
        }
        for (const float share : {0.0f, 0.37f, 1.0f}) {
          const float at = s.t_near + share * (s.t_far - s.t_near);
          const Vec3f p = ray.origin + ray.direction * at;
          for (int a = 0; a < 3 && s.t_far > s.t_near; ++a) {
            ASSERT_GE(static_cast<double>(p[a]), static_cast<double>(s.cell.lower[a]) - rounding);
            ASSERT_LE(static_cast<double>(p[a]), static_cast<double>(s.cell.upper[a]) + rounding);
          }
          const Vec3f looked_up = min(max(p, s.cell.lower), s.cell.upper);
          ASSERT_LE(classify_mu_t(medium.function.view(), sample_trilinear(medium.grid, looked_up)),
                    s.mu_maj);
        }
      }
    });
    return t;
  }

  static Interval<float> inside(const Medium& medium, const Ray& ray) {
    return clip_ray(medium.grid.index_box(), ray.origin, ray.direction, 0.0f,
                    std::numeric_limits<float>::infinity());
  }

  template <class Visit>
  void each_medium(Visit&& visit) {
    for (const Size3& size :
         {Size3{1, 1, 1}, Size3{3, 5, 7}, Size3{9, 6, 1}, Size3{1, 17, 4}, Size3{26, 33, 20}})
      for (const int c : {1, 2, 3, 8}) {
        SCOPED_TRACE(testing::Message()
                     << size[0] << " x " << size[1] << " x " << size[2] << ", cells of " << c);
        visit(Medium(size, c, GetParam().choice));
        if (HasFailure()) return;
      }
  }
};

TEST_P(Walks, RandomRaysTileTheirInterval) {
  Rng rng(82, 0, 0, 0);
  each_medium([&](const Medium& medium) {
    const Box3f domain = medium.grid.index_box();
    for (int n = 0; n < 1000 && !HasFailure(); ++n) {
      Ray ray{domain.lower + domain.extent() * Vec3f(rng.next(), rng.next(), rng.next()),
              random_direction(rng) * (0.1f + 2 * rng.next())};
      if (n % 3 == 0) ray.direction[n / 3 % 3] = 0;
      if (n % 2)
        ray.origin = ray.origin + ray.direction *
                                      std::min(inside(medium, {ray.origin, -ray.direction}).t_far, 1e9f) *
                                      -1.0f;
      const float length_mm =
          inside(medium, {min(max(ray.origin, domain.lower), domain.upper), ray.direction}).t_far;
      const float wanted = n % 5 == 0 ? length_mm * rng.next() : length_mm;
      const float walked = walk(medium, ray, wanted);
      float slowest = 1e30f;
      for (int a = 0; a < 3; ++a)
        if (ray.direction[a] != 0) slowest = std::min(slowest, std::abs(ray.direction[a]));
      EXPECT_NEAR(walked, wanted, 1e-5f * (1 + wanted) + 1e-4f / slowest);
      EXPECT_LE(walked, wanted);
    }
  });
}

TEST_P(Walks, DegenerateRaysTileTheirInterval) {
  // Origins on corners, edges, faces, centres and the border; directions along axes, faces and diagonals.
  const float directions[] = {-1, 0, 1, -0.0f, 0.5f, 1e-20f, -1e-7f};
  each_medium([&](const Medium& medium) {
    std::vector<float> coordinates[3];
    for (int a = 0; a < 3; ++a) {
      const float c = medium.cells.cell_voxels, last = medium.cells.domain.upper[a];
      for (const float x : {-0.5f, 0.0f, c, 2 * c, 0.3f * last, last})
        if (x <= last) coordinates[a].push_back(x);
    }
    for (const float x : coordinates[0])
      for (const float y : coordinates[1])
        for (const float z : coordinates[2])
          for (int d = 0; d < 343 && !HasFailure(); ++d) {
            const Ray ray{{x, y, z}, {directions[d % 7], directions[d / 7 % 7], directions[d / 49]}};
            if (!(length(ray.direction) > 0.1f)) continue;
            const Interval<float> run = inside(medium, ray);
            // A ray in the domain's upper faces may be taken for one that has left it.
            bool at_end = false;
            for (int a = 0; a < 3; ++a) at_end |= ray.origin[a] == medium.cells.domain.upper[a];
            const float walked = walk(medium, ray, run.t_far);
            if (!at_end) {
              EXPECT_NEAR(walked, run.t_far, 1e-5f * (1 + run.t_far));
            }
          }
  });
}

TEST_P(Walks, RaysThroughCornersSeeWhatIsBetween) {
  // Along a diagonal of voxels, through the corners of all cells.
  each_medium([&](const Medium& medium) {
    for (int signs = 0; signs < 8; ++signs) {
      Ray ray;
      for (int a = 0; a < 3; ++a) {
        ray.direction[a] = signs >> a & 1 ? -1.0f : 1.0f;
        ray.origin[a] = ray.direction[a] > 0 ? 0.0f : medium.cells.domain.upper[a] - 0.5f;
      }
      const float run = inside(medium, ray).t_far;
      EXPECT_FLOAT_EQ(walk(medium, ray, run), run);
    }
  });
}

TEST_P(Walks, EmptyIntervalsHaveNoRuns) {
  const Medium medium({9, 5, 5}, 2, GetParam().choice);
  for (const float length_mm : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()})
    with_walk(medium.view, {1, 1, 1}, {1, 0, 0}, length_mm, [&](auto& w) {
      MajorantSegment s;
      EXPECT_FALSE(w.next(s));
    });
}

TEST_P(Walks, TinyAndMeaninglessDirectionsEnd) {
  const Medium medium({9, 9, 9}, 2, GetParam().choice);
  for (const float tiny : {1e-39f, -1e-39f, 1e-45f, -1e-45f, 1e-38f, 1e-21f, -1e-19f})
    for (const Ray& ray : {Ray{{-0.5f, 4, 4}, {1, tiny, 0}}, Ray{{4, -0.5f, 4}, {tiny, 1, tiny}},
                           Ray{{-0.5f, 8.25f, 4}, {1, tiny, 0}}})
      EXPECT_EQ(walk(medium, ray, 9), 9.0f);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const Ray& ray :
       {Ray{{nan, 1, 1}, {1, 0, 0}}, Ray{{1, nan, 1}, {1, 0, 0}}, Ray{{1, 1, nan}, {0, 0, 1}},
        Ray{{1, 1, 1}, {nan, nan, nan}}, Ray{{1, 1, 1}, {nan, 1, 0}}, Ray{{nan, nan, nan}, {nan, 1, 1}}})
    with_walk(medium.view, ray.origin, ray.direction, 5, [&](auto& w) {
      MajorantSegment s;
      int runs = 0;
      while (w.next(s) && runs < 100) ++runs;
      EXPECT_LT(runs, 100);
    });
}

TEST_P(Walks, RoundingAtTheBorderLosesNothing) {
  Rng rng(84, 0, 0, 0);
  const Medium medium({9, 9, 9}, 2, GetParam().choice);
  for (int n = 0; n < 5000 && !HasFailure(); ++n) {
    // Up to some roundings outside the domain, as the clipping of a ray from far away leaves them.
    Ray ray{{8 * rng.next(), 8 * rng.next(), 8 * rng.next()}, random_direction(rng)};
    const int axis = n % 3;
    ray.origin[axis] = n % 2 ? -0.5000002f : 8.500002f;
    ray.direction[axis] = (n % 2 ? 1.0f : -1.0f) * std::abs(ray.direction[axis]);
    Ray entering = ray;
    entering.origin[axis] = n % 2 ? -0.5f : 8.5f;
    const float run = inside(medium, entering).t_far;
    const float walked = walk(medium, ray, std::nextafter(run, 1e30f));
    EXPECT_NEAR(walked, run, 1e-4f + 1e-5f / std::abs(ray.direction[axis]));
  }
}

TEST_P(Walks, LargeVolumesTile) {
  Rng rng(83, 0, 0, 0);
  const Medium medium({300, 20, 40}, 1, GetParam().choice);
  for (int n = 0; n < 1500 && !HasFailure(); ++n) {
    const Vec3f target(299 * rng.next(), 19 * rng.next(), 39 * rng.next());
    Ray ray{target, random_direction(rng)};
    if (n % 2) ray.direction = {n % 4 > 1 ? 1.0f : -1.0f, 1e-4f * rng.next(), -1e-4f * rng.next()};
    const float run = inside(medium, ray).t_far;
    EXPECT_NEAR(walk(medium, ray, run), run, 1e-3f);
  }
}

constexpr AcceleratorKind kHierarchy = AcceleratorKind::kHierarchy,
                          kThresholds = AcceleratorKind::kThresholdOctree;
constexpr float kHuge = 1e30f;
INSTANTIATE_TEST_SUITE_P(Structures, Walks,
                         testing::Values(structure("macrocell", AcceleratorKind::kMacrocell),
                                         structure("hierarchy", kHierarchy),
                                         structure("hierarchy_of_cells", kHierarchy, {2.5f, 0}),
                                         structure("hierarchy_of_blocks", kHierarchy, {0, 6}),
                                         structure("hierarchy_to_level_2", kHierarchy, {8, 2}),
                                         structure("skipping_octree", AcceleratorKind::kSkippingOctree),
                                         structure("thresholds", kThresholds),
                                         structure("thresholds_finest", kThresholds, {}, {0, 0}),
                                         structure("thresholds_coarsest", kThresholds, {}, {kHuge, kHuge}),
                                         structure("thresholds_stay", kThresholds, {}, {0, kHuge}),
                                         structure("thresholds_crossed", kThresholds, {}, {1, 0.1f}),
                                         structure("residency", AcceleratorKind::kResidency)),
                         [](const auto& test) { return std::string(test.param.name); });

}  // namespace
}  // namespace voxlume
