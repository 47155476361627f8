#include "volume_io/vdb_read.h"

#include <fmt/format.h>

#include "base/fail.h"
#include "volume_io/file_format.h"

#ifdef VOXLUME_WITH_VDB

#include <openvdb/openvdb.h>

#include <algorithm>

#include "volume_io/geometry_check.h"

namespace voxlume {
namespace {

using openvdb::CoordBBox;
using openvdb::FloatGrid;

std::string grid_names(const openvdb::GridPtrVec& grids) {
  std::string names;
  for (const openvdb::GridBase::Ptr& grid : grids) {
    names +=
        fmt::format("{}\"{}\" ({})", names.empty() ? "" : ", ", one_line(grid->getName()), grid->valueType());
  }
  return names;
}

class VdbReader : public VolumeReader {
 public:
  explicit VdbReader(const std::filesystem::path& path) : path_(path), file_(path.string()) {}

  VolumeHeader read_header(const Progress&) override {
    VolumeHeader header;
    Volume& volume = header.volume;
    openvdb::initialize();
    // Leaves are loaded from the file one by one while read_voxels copies and frees them.
    file_.setCopyMaxBytes(0);
    file_.open(true);
    choose_grid(volume);
    box_ = grid_->evalActiveVoxelBoundingBox();
    if (box_.empty()) fail(ErrorCode::kBadFormat, path_, "the float grid has no active voxels");
    set_geometry(volume);
    volume.format = format_name(FileFormat::kVdb);
    volume.type = VoxelType::kF32;
    // The tree without its voxels: masks and inner nodes.
    header.working_bytes = header.stored_bytes() / 8;
    if (grid_->getGridClass() == openvdb::GRID_LEVEL_SET) {
      volume.warnings.push_back("the grid is a level set: its values are distances, not densities");
    }
    return header;
  }

  void read_voxels(void* voxels, const Progress& progress) override {
    out_ = static_cast<float*>(voxels);
    const float background = grid_->background();
    if (background != 0) fill(box_, background);
    FloatGrid::TreeType& tree = grid_->tree();
    auto tiles = tree.cbeginValueAll();
    tiles.setMaxDepth(FloatGrid::TreeType::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tiles; ++tiles) {
      const float value = tiles.getValue();
      if (value == background) continue;
      CoordBBox tile;
      if (tiles.getBoundingBox(tile)) fill(tile, value);
    }
    ProgressCounter leaves(static_cast<std::int64_t>(tree.leafCount()), progress);
    for (auto leaf = tree.beginLeaf(); leaf; ++leaf) {
      copy_leaf(*leaf);
      FloatGrid::TreeType::LeafNodeType::Buffer freed(openvdb::PartialCreate(), 0.0f);  // holds nothing
      leaf->swap(freed);
      leaves.add();
    }
  }

 private:
  void choose_grid(Volume& volume) {
    const openvdb::GridPtrVecPtr metadata = file_.readAllGridMetadata();
    std::string name;
    std::size_t index = 0;
    for (; index < metadata->size() && !(*metadata)[index]->isType<FloatGrid>(); ++index) {
    }
    if (index == metadata->size()) {
      fail(ErrorCode::kUnsupported, path_,
           metadata->empty() ? "no grids in this file; expected a float grid"
                             : fmt::format("grids {}; expected a float grid", grid_names(*metadata)));
    }
    const openvdb::GridBase::Ptr found = file_.readGrid((*metadata)[index]->getName());
    grid_ = openvdb::gridPtrCast<FloatGrid>(found);
    if (!grid_) fail(ErrorCode::kBadFormat, path_, "the grid is not of the type its description says");
    if (metadata->size() > 1) {
      volume.warnings.push_back(fmt::format("{} grids in this file: {}; the first float grid is read",
                                            metadata->size(), grid_names(*metadata)));
    }
  }

  void set_geometry(Volume& volume) const {
    const openvdb::math::Transform& transform = grid_->transform();
    if (!transform.isLinear()) {
      fail(ErrorCode::kUnsupported, path_,
           fmt::format("a {} transform; expected an affine one", one_line(transform.mapType())));
    }
    for (int a = 0; a < 3; ++a) {
      volume.size[a] = std::int64_t{box_.max()[a]} - box_.min()[a] + 1;
    }
    // OpenVDB multiplies row vectors: row a of its matrix is the step along index axis a.
    const openvdb::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
    std::array<double, 9> mm_per_voxel{};
    for (int r = 0; r < 3; ++r) {
      for (int a = 0; a < 3; ++a) mm_per_voxel[3 * r + a] = matrix(a, r);
    }
    set_axes(volume, mm_per_voxel);
    const openvdb::Vec3d origin = transform.indexToWorld(box_.min());
    volume.origin_mm = {origin.x(), origin.y(), origin.z()};
  }

  std::size_t offset(const openvdb::Coord& at) const {
    const auto width = static_cast<std::size_t>(box_.dim().x());
    const auto height = static_cast<std::size_t>(box_.dim().y());
    const openvdb::Coord p = at - box_.min();
    return (static_cast<std::size_t>(p.z()) * height + p.y()) * width + p.x();
  }

  void fill(CoordBBox where, float value) {
    where.intersect(box_);
    if (where.empty()) return;
    for (int z = where.min().z(); z <= where.max().z(); ++z) {
      for (int y = where.min().y(); y <= where.max().y(); ++y) {
        std::fill_n(out_ + offset({where.min().x(), y, z}), where.dim().x(), value);
      }
    }
  }

  void copy_leaf(const FloatGrid::TreeType::LeafNodeType& leaf) {
    CoordBBox where = leaf.getNodeBoundingBox();
    where.intersect(box_);
    if (where.empty()) return;
    for (int z = where.min().z(); z <= where.max().z(); ++z) {
      for (int y = where.min().y(); y <= where.max().y(); ++y) {
        float* row = out_ + offset({where.min().x(), y, z});
        for (int x = where.min().x(); x <= where.max().x(); ++x) *row++ = leaf.getValue({x, y, z});
      }
    }
  }

  std::filesystem::path path_;
  openvdb::io::File file_;
  FloatGrid::Ptr grid_;
  CoordBBox box_;
  float* out_ = nullptr;
};

}  // namespace

std::unique_ptr<VolumeReader> make_vdb_reader(const std::filesystem::path& path) {
  return std::make_unique<VdbReader>(path);
}

}  // namespace voxlume

#else

namespace voxlume {

std::unique_ptr<VolumeReader> make_vdb_reader(const std::filesystem::path& path) {
  fail(ErrorCode::kUnsupported, path, "OpenVDB file; this voxlume was built without OpenVDB");
}

}  // namespace voxlume

#endif
