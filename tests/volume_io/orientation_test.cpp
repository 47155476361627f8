#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "nifti_builder.h"
#include "test_files.h"

namespace voxlume::test {
namespace {

using Vec = std::array<double, 3>;

/// A synthetic head in LPS mm: a smooth skull-like ellipsoid with marks that break every symmetry.
double head(const Vec& p) {
  const double r = std::sqrt(p[0] * p[0] / 4900 + p[1] * p[1] / 8100 + p[2] * p[2] / 6400);
  const auto blob = [&](double x, double y, double z) {
    const double d2 = (p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y) + (p[2] - z) * (p[2] - z);
    return std::exp(-d2 / 800);
  };
  return 1000 * std::exp(-8 * (r - 0.8) * (r - 0.8)) + 700 * blob(40, 0, 0) + 500 * blob(0, -60, 10) +
         300 * blob(5, 0, 50);
}

Volume head_volume(const std::array<double, 9>& direction, const Vec& spacing_mm) {
  Volume frame;
  frame.size = {72, 76, 70};
  frame.spacing_mm = spacing_mm;
  frame.direction = direction;
  const Vec centre = {35.5, 37.5, 34.5};
  const Vec away = p_world_of(frame, centre);
  frame.origin_mm = {-away[0], -away[1], -away[2]};
  Volume volume =
      make_volume(VoxelType::kF32, frame.size, [&](std::int64_t i, std::int64_t j, std::int64_t k) {
        return head(
            p_world_of(frame, {static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)}));
      });
  volume.spacing_mm = frame.spacing_mm;
  volume.origin_mm = frame.origin_mm;
  volume.direction = frame.direction;
  return volume;
}

/// Interpolated values of both agree with the head they were made from, at points all over it.
void expect_same_head(const Volume& a, const Volume& b) {
  // Linear interpolation of blobs 20 mm wide on a grid of about 3 mm is off by h^2/8 times the second
  // derivative.
  constexpr double kInterpolation = 12;
  int points = 0;
  for (double z = -60; z <= 60; z += 7.3) {
    for (double y = -60; y <= 60; y += 7.1) {
      for (double x = -60; x <= 60; x += 6.7) {
        if (x * x + y * y + z * z > 3600) continue;
        const double va = interpolate(a, p_index_of(a, {x, y, z}));
        const double vb = interpolate(b, p_index_of(b, {x, y, z}));
        ASSERT_NEAR(va, head({x, y, z}), kInterpolation) << x << " " << y << " " << z;
        ASSERT_NEAR(vb, head({x, y, z}), kInterpolation) << x << " " << y << " " << z;
        ++points;
      }
    }
  }
  EXPECT_GT(points, 2000);
}

TEST(Orientation, ObliqueAndAxialHeadsAgreeAtEveryPoint) {
  const TemporaryFolder folder;
  const Volume axial = head_volume({1, 0, 0, 0, 1, 0, 0, 0, 1}, {2.8, 2.8, 2.8});
  const Volume oblique = head_volume(
      rotation({1 / std::sqrt(3.0), 1 / std::sqrt(3.0), -1 / std::sqrt(3.0)}, 0.6), {2.7, 2.8, 2.9});
  const Volume flipped = head_volume({-1, 0, 0, 0, 0, 1, 0, -1, 0}, {2.8, 2.9, 2.7});
  const Volume left_handed = head_volume({1, 0, 0, 0, -1, 0, 0, 0, 1}, {2.8, 2.8, 2.8});
  for (const std::string extension : {".nii", ".nii.gz", ".nrrd", ".mha"}) {
    const auto back = [&](const char* name, const Volume& volume) {
      write_volume(volume, folder / (name + extension));
      return read_volume(folder / (name + extension));
    };
    const Volume reference = back("axial", axial);
    expect_same_head(reference, back("oblique", oblique));
    expect_same_head(reference, back("flipped", flipped));
    expect_same_head(reference, back("left", left_handed));
  }
}

std::string voxels_2x2x2() { return bytes_of<std::int16_t>({0, 1, 2, 3, 4, 5, 6, 7}); }

Volume read_nifti(const NiftiBuilder& builder) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.nii", builder.header() + voxels_2x2x2());
  return read_volume(folder / "a.nii");
}

TEST(Orientation, NiftiSformIsTurnedFromRasToLps) {
  NiftiBuilder nifti;
  nifti.sform_code = 1;
  nifti.srow = {2, 0, 0, -90, 0, 3, 0, -126, 0, 0, 4, -72};
  const Volume volume = read_nifti(nifti);
  EXPECT_EQ(volume.spacing_mm, (Vec{2, 3, 4}));
  EXPECT_EQ(volume.origin_mm, (Vec{90, 126, -72}));
  EXPECT_EQ(volume.direction, (std::array<double, 9>{-1, 0, 0, 0, -1, 0, 0, 0, 1}));
  EXPECT_TRUE(volume.warnings.empty());
}

TEST(Orientation, NiftiQuaternionRotates) {
  NiftiBuilder nifti;
  nifti.qform_code = 1;
  nifti.pixdim = {-1, 2, 2, 2, 1, 1, 1, 1};  // qfac -1 turns the third axis round
  const auto s = static_cast<float>(std::sqrt(0.5));
  nifti.quaternion = {0, 0, s, 10, 20, 30};  // 90 degrees about z: i goes to RAS +y, j to -x
  const Volume volume = read_nifti(nifti);
  const std::array<double, 9> expected = {0, 1, 0, -1, 0, 0, 0, 0, -1};
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(volume.direction[i], expected[i], 1e-6) << i;
  EXPECT_EQ(volume.origin_mm, (Vec{-10, -20, 30}));
}

TEST(Orientation, NiftiSformWinsOverAnotherQform) {
  NiftiBuilder nifti;
  nifti.qform_code = nifti.sform_code = 2;
  nifti.quaternion = {0, 1, 0, 90, 0, 0};
  nifti.srow = {-2, 0, 0, 90, 0, 2, 0, -126, 0, 0, 2, -72};
  const Volume volume = read_nifti(nifti);
  EXPECT_EQ(volume.origin_mm, (Vec{-90, 126, -72}));
  EXPECT_TRUE(warns(volume, "disagree"));
}

TEST(Orientation, NiftiShearedSformGivesWayToTheQform) {
  NiftiBuilder nifti;
  nifti.sform_code = 1;
  nifti.srow = {2, 0.5, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0};
  expect_error(ErrorCode::kBadFormat, "orthonormal", [&] { read_nifti(nifti); });
  nifti.qform_code = 1;
  const Volume volume = read_nifti(nifti);
  EXPECT_TRUE(warns(volume, "sheared"));
  EXPECT_EQ(volume.spacing_mm, (Vec{1, 1, 1}));
}

TEST(Orientation, NiftiUnitsBecomeMillimetres) {
  NiftiBuilder nifti;
  nifti.units = 3;  // micrometres
  nifti.pixdim = {1, 50, 50, 100, 1, 1, 1, 1};
  const Volume volume = read_nifti(nifti);
  EXPECT_NEAR(volume.spacing_mm[0], 0.05, 1e-12);
  EXPECT_NEAR(volume.spacing_mm[2], 0.1, 1e-12);
  EXPECT_TRUE(warns(volume, "no orientation"));
}

Volume read_nrrd(const std::string& space) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.nrrd",
              "NRRD0004\ntype: short\ndimension: 3\nsizes: 2 2 2\nendian: little\nencoding: raw\n" + space +
                  "\n" + voxels_2x2x2());
  return read_volume(folder / "a.nrrd");
}

TEST(Orientation, NrrdSpacesComeOutInLps) {
  const std::string axes = "space directions: (2,0,0) (0,0,3) (0,4,0)\nspace origin: (10,20,30)\n";
  const Volume ras = read_nrrd("space: right-anterior-superior\n" + axes);
  EXPECT_EQ(ras.spacing_mm, (Vec{2, 3, 4}));
  EXPECT_EQ(ras.origin_mm, (Vec{-10, -20, 30}));
  EXPECT_EQ(ras.direction, (std::array<double, 9>{-1, 0, 0, 0, 0, -1, 0, 1, 0}));
  const Volume las = read_nrrd("space: left-anterior-superior\n" + axes);
  EXPECT_EQ(las.origin_mm, (Vec{10, -20, 30}));
  EXPECT_EQ(las.direction, (std::array<double, 9>{1, 0, 0, 0, 0, -1, 0, 1, 0}));
  const Volume lps = read_nrrd("space: left-posterior-superior\n" + axes);
  EXPECT_EQ(lps.origin_mm, (Vec{10, 20, 30}));
  EXPECT_EQ(lps.direction, (std::array<double, 9>{1, 0, 0, 0, 0, 1, 0, 1, 0}));
}

TEST(Orientation, NrrdWithSpacingsOnly) {
  const Volume volume = read_nrrd("spacings: 0.5 0.6 0.7\n");
  EXPECT_EQ(volume.spacing_mm, (Vec{0.5, 0.6, 0.7}));
  EXPECT_EQ(volume.direction, (std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
}

TEST(Orientation, BadGeometryIsRefused) {
  const auto refuse = [](const std::string& space, const char* text) {
    expect_error(ErrorCode::kBadFormat, text, [&] { read_nrrd(space); });
  };
  const std::string lps = "space: left-posterior-superior\nspace directions: ";
  refuse(lps + "(0,0,0) (0,1,0) (0,0,1)\n", "");
  refuse(lps + "(1,0,0) (1,0,0) (0,0,1)\n", "singular");
  refuse(lps + "(1,0,0) (0.5,0.86,0) (0,0,1)\n", "orthonormal");
  refuse("spacings: 1 0 1\n", "");
  refuse("spacings: 1 -2 1\n", "");
}

TEST(Orientation, SlightlySkewAxesAreStraightenedWithAWarning) {
  const Volume volume = read_nrrd(
      "space: left-posterior-superior\nspace directions: (1,0,0) (0.003,1,0) (0,0,1)\nspace origin: "
      "(0,0,0)\n");
  EXPECT_TRUE(warns(volume, "perpendicular"));
  const auto& d = volume.direction;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      EXPECT_NEAR(d[a] * d[b] + d[3 + a] * d[3 + b] + d[6 + a] * d[6 + b], a == b ? 1 : 0, 1e-14);
    }
  }
  EXPECT_NEAR(d[1], 0.0015, 1e-5);
}

TEST(Orientation, SpacingCanBeOverridden) {
  const TemporaryFolder folder;
  write_volume(make_test_volume(VoxelType::kU8), folder / "a.nrrd");
  ReadOptions options;
  options.spacing_mm = {0.1, 0.2, 0.3};
  EXPECT_EQ(read_volume(folder / "a.nrrd", options).spacing_mm, (Vec{0.1, 0.2, 0.3}));
  options.spacing_mm = {0.1, 0, 0.3};
  expect_error(ErrorCode::kBadParameter, "spacing", [&] { read_volume(folder / "a.nrrd", options); });
}

/// Formats without orientation get the voxels reordered: what is at an LPS place stays there, up to TIFF's
/// lost origin.
TEST(Orientation, FormatsWithoutOrientationAreWrittenAlongLps) {
  const TemporaryFolder folder;
  Volume volume;
  volume.size = {2, 3, 4};
  volume.type = VoxelType::kU16;
  volume.spacing_mm = {1, 2, 3};
  volume.origin_mm = {10, 20, 30};
  // i runs to the head, j to the right, k to posterior.
  volume.direction = {0, -1, 0, 0, 0, 1, 1, 0, 0};
  auto voxels = std::make_shared<std::vector<std::uint16_t>>(24);
  for (std::size_t n = 0; n < 24; ++n) (*voxels)[n] = static_cast<std::uint16_t>(100 + n);
  volume.voxels = std::shared_ptr<const void>(voxels, voxels->data());
  for (const char* name : {"a.vtk", "a.tif"}) {
    write_volume(volume, folder / name);
    const Volume back = read_volume(folder / name);
    EXPECT_EQ(back.size, (std::array<std::int64_t, 3>{3, 4, 2})) << name;
    EXPECT_NEAR(back.spacing_mm[0], 2, 1e-6) << name;
    EXPECT_NEAR(back.spacing_mm[1], 3, 1e-6) << name;
    EXPECT_NEAR(back.spacing_mm[2], 1, 1e-6) << name;
    const auto* read = static_cast<const std::uint16_t*>(back.voxels.get());
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t j = 0; j < 3; ++j)
        for (std::size_t i = 0; i < 2; ++i)
          EXPECT_EQ(read[(2 - j) + 3 * k + 12 * i], (*voxels)[i + 2 * j + 6 * k]) << name;
    if (std::string_view(name) == "a.vtk") {
      EXPECT_EQ(back.origin_mm, (std::array<double, 3>{6, 20, 30}));
    } else {
      EXPECT_THAT(back.warnings, testing::Contains(testing::HasSubstr("no orientation")));
    }
  }
}

}  // namespace
}  // namespace voxlume::test
