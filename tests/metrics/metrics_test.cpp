#include "metrics/metrics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pictures.h"
#include "tonemap/srgb.h"
#include "voxlume/error.h"

namespace voxlume::test {
namespace {

TEST(Rmse, HandComputed) {
  Image a = constant(2, 1, 0), b = constant(2, 1, 0);
  a.rgba = {1, 0, 0, 1, 0, 0, 0, 1};
  b.rgba = {0, 2, 0, 1, 0, 0, -1, 0};
  EXPECT_DOUBLE_EQ(rmse(a, b), 1.0);  // (1 + 4 + 1) / 6
  EXPECT_DOUBLE_EQ(rmse(b, a), 1.0);
  EXPECT_EQ(rmse(a, a), 0.0);
}

TEST(Rmse, OfDisplayValues) {
  const Image a = constant(3, 2, linear_from_srgb(0.5f)), b = constant(3, 2, linear_from_srgb(0.6f));
  EXPECT_NEAR(rmse(a, b, PixelValues::kDisplay), 0.1, 1e-6);
  EXPECT_EQ(rmse(constant(2, 2, 3), constant(2, 2, 5), PixelValues::kDisplay), 0.0);
}

TEST(Psnr, HandComputedOnDisplayValues) {
  // Encoded values 0.5 and 0.6: -10 log10(0.01) = 20 dB.
  const Image a = constant(3, 2, linear_from_srgb(0.5f)), b = constant(3, 2, linear_from_srgb(0.6f));
  EXPECT_NEAR(psnr(a, b).value(), 20.0, 1e-4);
  EXPECT_FALSE(psnr(a, a).has_value());
}

TEST(Psnr, ClampsToTheDisplay) {
  EXPECT_FALSE(psnr(constant(2, 2, 3), constant(2, 2, 5)).has_value());
  EXPECT_FALSE(psnr(constant(2, 2, -1), constant(2, 2, 0)).has_value());
  EXPECT_NEAR(psnr(constant(2, 2, 9), constant(2, 2, 0)).value(), 0.0, 1e-5);  // white encodes to 1 - 2^-24
}

TEST(PsnrHdr, PeakIsTheQuantileOfTheReference) {
  // 3000 values of the reference: 2997 are 2, three are 1000. The 99.9 % quantile is the 2997th: 2.
  Image reference = constant(1000, 1, 2);
  for (int c = 0; c < 3; ++c) reference.rgba[c] = 1000;
  Image image = reference;
  for (float& value : image.rgba) value += 0.5f;
  EXPECT_NEAR(psnr_hdr(image, reference).value(), 20 * std::log10(2 / 0.5), 1e-4);
  // One more bright value moves it.
  reference.rgba[4] = 1000;
  image.rgba[4] = 1000.5f;
  EXPECT_NEAR(psnr_hdr(image, reference).value(), 20 * std::log10(1000 / 0.5), 1e-4);
  EXPECT_FALSE(psnr_hdr(reference, reference).has_value());
  EXPECT_FALSE(psnr_hdr(reference, constant(1000, 1, 0)).has_value());
}

TEST(Ssim, IdenticalIsOne) {
  const Image image = noise(20, 15, 1);
  EXPECT_DOUBLE_EQ(ssim(image, image).value(), 1.0);
}

TEST(Ssim, ConstantPicturesLeaveTheLuminanceTerm) {
  const Image a = constant(12, 12, linear_from_srgb(0.5f)), b = constant(12, 12, linear_from_srgb(0.8f));
  const double c1 = 1e-4;
  EXPECT_NEAR(ssim(a, b).value(), (2 * 0.5 * 0.8 + c1) / (0.25 + 0.64 + c1), 1e-5);
}

// The definition, one window and no separation.
TEST(Ssim, OneWindowByTheDefinition) {
  const Image a = noise(11, 11, 2), b = noise(11, 11, 3);
  const auto luma = [](const Image& image, int i) {
    const float* p = &image.rgba[4 * static_cast<std::size_t>(i)];
    return 0.2126 * srgb_from_linear(p[0]) + 0.7152 * srgb_from_linear(p[1]) +
           0.0722 * srgb_from_linear(p[2]);
  };
  double total = 0, ma = 0, mb = 0, vaa = 0, vbb = 0, vab = 0;
  std::vector<double> w(121);
  for (int i = 0; i < 121; ++i) {
    const double dx = i % 11 - 5, dy = i / 11 - 5;
    total += w[i] = std::exp(-(dx * dx + dy * dy) / 4.5);
  }
  for (int i = 0; i < 121; ++i) {
    ma += w[i] / total * luma(a, i);
    mb += w[i] / total * luma(b, i);
  }
  for (int i = 0; i < 121; ++i) {
    const double da = luma(a, i) - ma, db = luma(b, i) - mb;
    vaa += w[i] / total * da * da;
    vbb += w[i] / total * db * db;
    vab += w[i] / total * da * db;
  }
  const double c1 = 1e-4, c2 = 9e-4;
  const double expected = (2 * ma * mb + c1) * (2 * vab + c2) / ((ma * ma + mb * mb + c1) * (vaa + vbb + c2));
  EXPECT_NEAR(ssim(a, b).value(), expected, 1e-12);
}

TEST(Ssim, FallsWithNoiseAndNeedsAWindow) {
  const Image a = noise(40, 30, 4), other = noise(40, 30, 5);
  Image near = a;
  for (std::size_t i = 0; i < near.rgba.size(); ++i) near.rgba[i] += 0.05f * (other.rgba[i] - 0.5f);
  EXPECT_GT(ssim(near, a).value(), 0.9);
  EXPECT_LT(ssim(other, a).value(), 0.3);
  EXPECT_DOUBLE_EQ(ssim(near, a).value(), ssim(a, near).value());
  EXPECT_FALSE(ssim(noise(10, 40, 1), noise(10, 40, 2)).has_value());
}

TEST(Metrics, RefuseWhatCannotBeCompared) {
  const Image a = constant(12, 12, 1), wider = constant(13, 12, 1);
  Image bad = a;
  bad.rgba[4 * (12 * 3 + 5) + 1] = std::nanf("");
  for (const Image* b : {&wider, const_cast<const Image*>(&bad)}) {
    EXPECT_THROW(rmse(a, *b), Error);
    EXPECT_THROW(psnr(*b, a), Error);
    EXPECT_THROW(psnr_hdr(a, *b), Error);
    EXPECT_THROW(ssim(*b, a), Error);
  }
  EXPECT_THROW(rmse(Image(), Image()), Error);
  try {
    rmse(bad, a);
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("5,3"), std::string::npos) << error.what();
  }
}

TEST(Metrics, AlphaDoesNotCount) {
  const Image a = constant(12, 12, 0.5f);
  Image b = a;
  for (std::size_t i = 0; i < b.pixel_count(); ++i) b.rgba[4 * i + 3] = std::nanf("");
  EXPECT_EQ(rmse(a, b), 0.0);
  EXPECT_FALSE(psnr(a, b).has_value());
}

}  // namespace
}  // namespace voxlume::test
