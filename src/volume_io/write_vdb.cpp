#include "base/fail.h"
#include "volume_io/library_message.h"
#include "volume_io/volume_writers.h"

#ifdef VOXLUME_WITH_VDB

#include <openvdb/openvdb.h>

#include "volume_io/voxel_convert.h"

namespace voxlume {
namespace {

openvdb::math::Transform::Ptr transform_of(const Volume& volume) {
  openvdb::Mat4d matrix = openvdb::Mat4d::identity();
  for (int a = 0; a < 3; ++a) {
    for (int r = 0; r < 3; ++r) matrix(a, r) = volume.direction[3 * r + a] * volume.spacing_mm[a];
    matrix(3, a) = volume.origin_mm[a];
  }
  return openvdb::math::Transform::createLinearTransform(matrix);
}

void copy_voxels(const Volume& volume, openvdb::FloatGrid& grid) {
  using Leaf = openvdb::FloatGrid::TreeType::LeafNodeType;
  constexpr int kWidth = Leaf::DIM;
  const int nx = static_cast<int>(volume.size[0]);
  const int ny = static_cast<int>(volume.size[1]);
  const int nz = static_cast<int>(volume.size[2]);
  with_voxel_type(volume.type, [&](auto zero) {
    const auto* voxels = static_cast<const decltype(zero)*>(volume.voxels.get());
    for (int z0 = 0; z0 < nz; z0 += kWidth) {
      for (int y0 = 0; y0 < ny; y0 += kWidth) {
        for (int x0 = 0; x0 < nx; x0 += kWidth) {
          Leaf& leaf = *grid.tree().touchLeaf({x0, y0, z0});
          for (int z = z0; z < std::min(z0 + kWidth, nz); ++z) {
            for (int y = y0; y < std::min(y0 + kWidth, ny); ++y) {
              const auto* row = voxels + (static_cast<std::size_t>(z) * ny + y) * nx;
              for (int x = x0; x < std::min(x0 + kWidth, nx); ++x) {
                leaf.setValueOn({x, y, z}, static_cast<float>(row[x]));
              }
            }
          }
        }
      }
    }
  });
}

}  // namespace

void write_vdb(const Volume& volume, const std::filesystem::path& path) {
  for (const std::int64_t n : volume.size) {
    if (n > openvdb::Int32(1) << 30) fail(ErrorCode::kUnsupported, path, "a volume too wide for OpenVDB");
  }
  try {
    openvdb::initialize();
    const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(transform_of(volume));
    copy_voxels(volume, *grid);
    openvdb::io::File file(path.string());
    file.write({grid});
    file.close();
  } catch (const std::exception& error) {
    fail(ErrorCode::kInternal, path, "cannot be written: " + library_message(error.what()));
  }
}

}  // namespace voxlume

#else

namespace voxlume {

void write_vdb(const Volume&, const std::filesystem::path& path) {
  fail(ErrorCode::kUnsupported, path, "this voxlume was built without OpenVDB");
}

}  // namespace voxlume

#endif
