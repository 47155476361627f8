#include "scene/label_values.h"

#include <gmock/gmock.h>

#include <cmath>

#include "support/volumes.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Voxels of these values, one after the other in three slices.
template <class T>
Volume volume_of(const std::vector<double>& values) {
  return test::make_volume<T>({4, 5, 3}, [&](auto i, auto j, auto k) {
    return values[static_cast<std::size_t>(i + 4 * (j + 5 * k)) % values.size()];
  });
}

template <class T>
std::vector<float> labels_of(const std::vector<double>& values) {
  const Volume volume = volume_of<T>(values);
  return label_values(make_grid_view(volume), "a.nrrd");
}

template <class T>
std::string refusal(const std::vector<double>& values) {
  try {
    labels_of<T>(values);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFormat);
    return error.what();
  }
  return "";
}

TEST(LabelValues, AreThoseThatOccurWhateverTheType) {
  EXPECT_THAT(labels_of<std::uint8_t>({53, 2, 17, 2}), ElementsAre(2, 17, 53));
  EXPECT_THAT(labels_of<std::int16_t>({0, -3, 2035}), ElementsAre(-3, 0, 2035));
  EXPECT_THAT(labels_of<std::int32_t>({14175, 2, 11101, 12175}), ElementsAre(2, 11101, 12175, 14175));
  EXPECT_THAT(labels_of<float>({2035, 53, 17, 2}), ElementsAre(2, 17, 53, 2035));
  EXPECT_THAT(labels_of<double>({8388607, -8388607}), ElementsAre(-8388607, 8388607));
  EXPECT_THAT(labels_of<float>({NAN, 1, INFINITY}), ElementsAre(1));
  EXPECT_THAT(labels_of<float>({NAN}), ElementsAre());
}

TEST(LabelValues, OthersAreRefused) {
  EXPECT_THAT(refusal<float>({1, 1.5}), HasSubstr("a.nrrd: expected a label volume of whole numbers"));
  EXPECT_THAT(refusal<std::int32_t>({1, 8388608}), HasSubstr("found 8388608"));
  EXPECT_THAT(refusal<double>({-1e12}), HasSubstr("expected labels from -8388607"));
}

}  // namespace
}  // namespace voxlume
