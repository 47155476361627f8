// Draws the octree of majorants as xu2025 Fig. 5: a column for each level from the root to the leaves; above
// the extents of its nodes, below those that hold something visible. Usage: voxlume_hierarchy_levels
// SCENE_OR_VOLUME OUT.png [LEAF_LEVEL] [EDGE]
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "base/parallel.h"
#include "image_io/image_io.h"
#include "measure.h"
#include "voxlume/error.h"

namespace {

using namespace voxlume;

/// One level of the octree as a uniform grid.
MajorantView level_grid(const OctreeView& octree, int level) {
  MajorantView view;
  view.mu_maj = octree.levels[level].mu_maj;
  for (int a = 0; a < 3; ++a) view.cells[a] = (octree.count[a] + (1 << level) - 1) >> level;
  view.cell_voxels = octree.cell_voxels * static_cast<float>(1 << level);
  view.domain = octree.domain;
  return view;
}

Vec3f level_color(int level, int levels) {
  const float hue = 5.0f * static_cast<float>(level) / static_cast<float>(std::max(levels, 1));
  const auto channel = [&](float shift) {
    const float x = std::fmod(hue + shift, 6.0f);
    return 0.35f + 0.6f * std::clamp(std::abs(x - 3.0f) - 1.0f, 0.0f, 1.0f);
  };
  return {channel(0), channel(4), channel(2)};
}

/// The face by which a ray enters a node, and how near to the node's edge.
struct Hit {
  int axis;
  bool edge;
};

Hit hit_at(const Box3f& cell, Vec3f p) {
  Vec3f distance;  // to the nearer face of each axis, in parts of the node
  for (int a = 0; a < 3; ++a) {
    const float extent = cell.upper[a] - cell.lower[a];
    distance[a] = std::min(std::abs(p[a] - cell.lower[a]), std::abs(p[a] - cell.upper[a])) / extent;
  }
  const int axis =
      distance.x < distance.y ? (distance.x < distance.z ? 0 : 2) : (distance.y < distance.z ? 1 : 2);
  float nearest = 1;
  for (int a = 0; a < 3; ++a)
    if (a != axis) nearest = std::min(nearest, distance[a]);
  return {axis, nearest < 0.04f};
}

Vec3f shade(const SceneView& scene, const MajorantView& nodes, bool visible_only, Vec3f color, float px,
            float py) {
  const CameraRay eye = camera_ray(scene.camera, px, py, 0.5f, 0.5f);
  const IndexRay ray = to_index_ray(scene.medium.grid, eye.origin, eye.direction);
  const Interval<float> run = clip_ray(nodes.domain, ray.origin_index, ray.direction_index, 0.0f,
                                       std::numeric_limits<float>::infinity());
  if (run.empty()) return Vec3f(1);
  MacrocellWalk walk(nodes, ray.origin_index, ray.direction_index, run.t_near, run.t_far);
  MajorantSegment segment;
  while (walk.next(segment)) {
    if ((visible_only && !(segment.mu_maj > 0)) || segment.t_far <= segment.t_near) continue;
    const Hit hit = hit_at(segment.cell, ray.origin_index + ray.direction_index * segment.t_near);
    constexpr float kLight[3] = {0.8f, 0.65f, 1.0f};
    return color * (kLight[hit.axis] * (hit.edge ? 0.35f : 1.0f));
  }
  return Vec3f(1);
}

Image8 draw(const SceneView& scene, const OctreeView& octree, int edge) {
  constexpr int kSub = 4;
  const int levels = octree.top_level + 1;
  Image8 image;
  image.width = levels * edge;
  image.height = 2 * edge;
  image.values.resize(static_cast<std::size_t>(image.width) * image.height * 3);
  parallel_for(image.height, 4, [&](std::int64_t row) {
    for (int x = 0; x < image.width; ++x) {
      const int column = x / edge, level = octree.top_level - column;
      const MajorantView nodes = level_grid(octree, level);
      Vec3f sum(0);
      for (int s = 0; s < kSub * kSub; ++s)
        sum += shade(scene, nodes, row >= edge, level_color(column, levels),
                     static_cast<float>(x % edge) + (static_cast<float>(s % kSub) + 0.5f) / kSub,
                     static_cast<float>(row % edge) + (static_cast<float>(s / kSub) + 0.5f) / kSub);
      for (int c = 0; c < 3; ++c)
        image.values[(static_cast<std::size_t>(row) * image.width + x) * 3 + c] =
            static_cast<std::uint8_t>(255.0f * std::clamp(sum[c] / (kSub * kSub), 0.0f, 1.0f) + 0.5f);
    }
  });
  return image;
}

void print_counts(const OctreeView& octree) {
  std::printf("| level | nodes | with visible values |\n|---|---|---|\n");
  for (int level = octree.top_level; level >= 0; --level) {
    const MajorantView nodes = level_grid(octree, level);
    const std::int64_t count = std::int64_t{nodes.cells[0]} * nodes.cells[1] * nodes.cells[2];
    std::printf("| %d | %lld | %lld |\n", octree.top_level - level, static_cast<long long>(count),
                static_cast<long long>(
                    std::count_if(nodes.mu_maj, nodes.mu_maj + count, [](float m) { return m > 0; })));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 5) {
    std::fprintf(stderr, "usage: voxlume_hierarchy_levels SCENE_OR_VOLUME OUT.png [LEAF_LEVEL] [EDGE]\n");
    return 2;
  }
  try {
    LoadedScene loaded(argv[1]);
    const int leaf_level = argc > 3 ? std::clamp(std::atoi(argv[3]), 0, 10) : 6;
    const int edge = argc > 4 ? std::max(16, std::atoi(argv[4])) : 220;
    loaded.description.image.width = loaded.description.image.height = edge;
    const auto scene = loaded.compile(loaded.description);
    const GridView grid = make_grid_view(loaded.volume);
    MajorantOctree octree(grid, octree_cell_voxels(grid, leaf_level));
    octree.update(TransferFunction(scene->description().transfer));
    write_png(draw(scene->view(), octree.view(), edge), argv[2]);
    print_counts(octree.view());
  } catch (const Error& error) {
    std::fprintf(stderr, "voxlume_hierarchy_levels: %s\n", error.what());
    return 1;
  }
  return 0;
}
