#include <gtest/gtest.h>

#include "support/transfers.h"
#include "transfer/transfer_function.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using test::mu_t_function;
using test::opacity_function;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN(),
                 kInfinity = std::numeric_limits<double>::infinity();

void expect_refused(const TransferDescription& d, const std::string& where) {
  try {
    const TransferFunction function(d);
    FAIL() << "accepted, expected an error at " << where;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadParameter);
    EXPECT_EQ(error.where(), where);
    EXPECT_FALSE(error.message().empty());
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    EXPECT_EQ(std::string(error.what()).find(where + ": "), 0u);
  }
}

TEST(Validation, Values) {
  expect_refused(mu_t_function({{0, 1}, {kNaN, 1}}), "/transfer/points/1");
  expect_refused(mu_t_function({{0, 1}, {kInfinity, 1}}), "/transfer/points/1");
  expect_refused(mu_t_function({{-1e300, 1}, {0, 1}}), "/transfer/points/0");  // not a float
  expect_refused(mu_t_function({{0, 1}, {2, 1}, {1, 1}}), "/transfer/points/2");
}

TEST(Validation, Opacities) {
  for (const double bad : {-0.01, 1.01, kNaN, kInfinity, -kInfinity})
    expect_refused(opacity_function({{0, 0.5}, {1, bad}}, 1.0), "/transfer/points/1");
  EXPECT_NO_THROW(TransferFunction(opacity_function({{0, 0}, {1, 1}}, 1.0)));
}

TEST(Validation, Extinctions) {
  for (const double bad : {-1e-9, kNaN, kInfinity})
    expect_refused(mu_t_function({{0, bad}}), "/transfer/points/0");
}

TEST(Validation, OpacityOrExtinctionButNotBoth) {
  TransferDescription d = mu_t_function({{0, 1}, {1, 1}, {2, 1}});
  d.points[2].mu_t_per_mm.reset();
  d.points[2].opacity = 0.5;
  expect_refused(d, "/transfer/points/2");
}

TEST(Validation, ReferenceLengthAndScale) {
  for (const double bad : {0.0, -1.0, kNaN, kInfinity}) {
    TransferDescription d = mu_t_function({{0, 1}});
    d.reference_length_mm = bad;
    expect_refused(d, "/transfer/reference_length_mm");
  }
  TransferDescription d = mu_t_function({{0, 1}});
  d.reference_length_mm.reset();
  expect_refused(d, "/transfer/reference_length_mm");
  for (const double bad : {-1.0, kNaN, kInfinity}) {
    TransferDescription scaled = mu_t_function({{0, 1}});
    scaled.density_scale = bad;
    expect_refused(scaled, "/transfer/density_scale");
  }
}

}  // namespace
}  // namespace voxlume
