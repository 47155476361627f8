#include "transfer/range_extremes.h"

#include <gtest/gtest.h>

#include "support/every_target.h"
#include "support/transfers.h"
#include "transfer/transfer_function.h"

namespace voxlume {
namespace {

using test::CurvePoints;
using test::for_every_target;
using test::mu_t_function;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kMost = std::numeric_limits<float>::max();

std::vector<TransferDescription> functions(Rng& rng) {
  std::vector<TransferDescription> out{mu_t_function({{0, 1}}),
                                       mu_t_function({{0, 0}}),
                                       mu_t_function({{-3e38, 1}, {3e38, 2}}),
                                       mu_t_function({{5, 1}, {5, 2}}),
                                       mu_t_function({{0, 0}, {1e-42, 3}, {2e-42, 0}}),
                                       mu_t_function({{1e6, 0}, {1e6 + 1, 7}, {1e6 + 2, 0}}),
                                       mu_t_function({{3e38, 1}, {3.2e38, 0}})};
  for (int f = 0; f < 40; ++f) {
    const double scale = std::pow(10.0, f % 7 - 2);
    CurvePoints points = test::random_curve(-scale, scale, 20.0, 1 + f * f % 300, rng);
    out.push_back(mu_t_function(points));
    // Visible here and there.
    CurvePoints gaps = points;
    for (auto& point : gaps) point.second *= rng.next() < 0.3f;
    out.push_back(mu_t_function(gaps));
    for (auto& point : points) point.second = std::min(point.second / 20, 1.0);
    out.push_back(test::opacity_function(points, 0.5));
  }
  return out;
}

/// Ranges of all widths, some empty, some at knots, some infinite.
std::vector<ValueRange> ranges_over(const TransferDescription& function, std::size_t count, Rng& rng) {
  const auto& points = function.points;
  const auto origin = static_cast<float>(points.front().value);
  const float width = std::max(1.0f, std::min(1e30f, static_cast<float>(points.back().value) - origin));
  const auto value = [&] {
    if (rng.next() < 0.2f)
      return static_cast<float>(points[static_cast<std::size_t>(rng.next() * points.size())].value);
    return origin + width * (1.4f * rng.next() - 0.2f);
  };
  std::vector<ValueRange> out{{1, 0},
                              {kMost, -kMost},
                              {-kMost, kMost},
                              {-kInfinity, kInfinity},
                              {kInfinity, kInfinity},
                              {-kInfinity, -kInfinity},
                              {-kInfinity, origin},
                              {origin, kInfinity},
                              {kMost, kInfinity}};
  while (out.size() < count) {
    const float lower = value(), narrow = rng.next() < 0.5f ? lower + 0.01f * width * rng.next() : value();
    out.push_back({std::min(lower, narrow), std::max(lower, narrow)});
    if (rng.next() < 0.1f) out.back().upper = out.back().lower;
    if (rng.next() < 0.2f) out.back().upper = out.back().lower + 1e-4f * width * rng.next();
  }
  return out;
}

TEST(RangeExtremes, VectorsGiveTheScalarNumbers) {
  Rng rng(21, 0, 0, 0);
  for (const TransferDescription& description : functions(rng)) {
    const TransferFunction function(description);
    // Not a multiple of any vector's length.
    const std::vector<ValueRange> ranges = ranges_over(description, 1003, rng);
    for_every_target([&] {
      std::vector<float> found(ranges.size() + 1, -1.0f);
      function.extremes().find_maxima(ranges.data(), static_cast<std::int64_t>(ranges.size()), 1.5f,
                                      found.data());
      for (std::size_t i = 0; i < ranges.size(); ++i)
        ASSERT_EQ(found[i], 1.5f * function.max_mu_t(ranges[i].lower, ranges[i].upper))
            << ranges[i].lower << " " << ranges[i].upper;
      EXPECT_EQ(found.back(), -1.0f) << "wrote beyond the end";
      function.extremes().find_minima(ranges.data(), static_cast<std::int64_t>(ranges.size()), found.data());
      for (std::size_t i = 0; i < ranges.size(); ++i)
        ASSERT_EQ(found[i], function.min_mu_t(ranges[i].lower, ranges[i].upper))
            << ranges[i].lower << " " << ranges[i].upper;
      EXPECT_EQ(found.back(), -1.0f) << "wrote beyond the end";
    });
  }
}

TEST(RangeExtremes, FewRangesAreFoundToo) {
  const TransferFunction function(mu_t_function({{0, 0}, {10, 1}}));
  for_every_target([&] {
    for (int count = 0; count < 40; ++count) {
      std::vector<ValueRange> ranges(static_cast<std::size_t>(count));
      for (int i = 0; i < count; ++i) ranges[static_cast<std::size_t>(i)] = {0, static_cast<float>(i % 10)};
      std::vector<float> found(static_cast<std::size_t>(count) + 1, -1.0f);
      function.extremes().find_maxima(ranges.data(), count, 1.0f, found.data());
      for (int i = 0; i < count; ++i)
        ASSERT_FLOAT_EQ(found[static_cast<std::size_t>(i)], 0.1f * static_cast<float>(i % 10));
      ASSERT_EQ(found.back(), -1.0f);
    }
  });
}

TEST(RangeExtremes, MorePiecesThanABucketCanName) {
  std::vector<TransferPiece> pieces(70000);
  Rng rng(24, 0, 0, 0);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto start = static_cast<float>(i);
    pieces[i] = {
        i == 0 ? -kInfinity : start, start, i % 100 == 0 ? 100 * rng.next() : rng.next(), 0, {}, {}, {}, {}};
  }
  const RangeExtremes extremes(pieces);
  std::vector<ValueRange> ranges;
  for (int n = 0; n < 64; ++n) {
    const float lower = 60000 + 10000 * rng.next();
    ranges.push_back({lower, lower + 200 * rng.next()});
  }
  for_every_target([&] {
    std::vector<float> found(ranges.size());
    extremes.find_maxima(ranges.data(), static_cast<std::int64_t>(ranges.size()), 1.0f, found.data());
    for (std::size_t n = 0; n < ranges.size(); ++n) {
      float greatest = 0;
      for (auto i = static_cast<std::size_t>(ranges[n].lower);
           i < pieces.size() && pieces[i].start <= ranges[n].upper; ++i)
        greatest = std::max(greatest, pieces[i].mu_t);
      ASSERT_EQ(found[n], greatest);
      ASSERT_EQ(extremes.maximum(ranges[n]), greatest);
    }
  });
}

/// Moves, adds and takes away points as a user who edits a function.
TransferDescription edited(TransferDescription d, Rng& rng) {
  auto& points = d.points;
  const auto at = static_cast<std::size_t>(rng.next() * points.size());
  switch (static_cast<int>(rng.next() * 6)) {
    case 0:
      points[at].mu_t_per_mm = 20.0 * static_cast<double>(rng.next());
      break;
    case 1: {
      const double below = at > 0 ? points[at - 1].value : points[at].value - 1;
      const double above = at + 1 < points.size() ? points[at + 1].value : points[at].value + 1;
      points[at].value = below + (above - below) * static_cast<double>(rng.next());
      break;
    }
    case 2:
      if (points.size() > 1) points.erase(points.begin() + static_cast<std::ptrdiff_t>(at));
      break;
    case 3: {
      TransferPoint added = points[at];
      added.mu_t_per_mm = 20.0 * static_cast<double>(rng.next());
      points.insert(points.begin() + static_cast<std::ptrdiff_t>(at), added);
      break;
    }
    case 4:
      d.density_scale *= 1.1;
      break;
    default:
      points[at].color = Color{{0.5f, 0.25f, 1}};
      break;
  }
  return d;
}

TEST(ChangedValues, OutsideThemEverySupremumStaysTheSame) {
  Rng rng(22, 0, 0, 0);
  int narrow = 0;
  for (int f = 0; f < 300; ++f) {
    const TransferDescription before = mu_t_function(test::random_curve(-1000, 3000, 20.0, 1 + f % 30, rng));
    const TransferDescription after = edited(before, rng);
    const TransferFunction a(before), b(after);
    const ValueRange changed = changed_values(a.extremes(), b.extremes());
    narrow += changed.upper - changed.lower < 3000;
    for (const ValueRange& range : ranges_over(before, 300, rng)) {
      if (!(range.upper < changed.lower || range.lower > changed.upper)) continue;
      ASSERT_EQ(a.max_mu_t(range.lower, range.upper), b.max_mu_t(range.lower, range.upper))
          << range.lower << " " << range.upper << " outside " << changed.lower << " " << changed.upper;
    }
  }
  EXPECT_GT(narrow, 100) << "nearly every edit is taken to change everything";
}

TEST(ChangedValues, AreNoneWhereNothingOrOnlyColorChanges) {
  Rng rng(23, 0, 0, 0);
  const TransferDescription function = mu_t_function(test::random_curve(-1000, 3000, 20.0, 9, rng));
  TransferDescription colored = function;
  for (TransferPoint& point : colored.points) point.color = Color{{1, 0, 0}};
  const TransferFunction a(function), b(function), c(colored);
  EXPECT_TRUE(changed_values(a.extremes(), b.extremes()).empty());
  EXPECT_TRUE(changed_values(a.extremes(), c.extremes()).empty());
}

TEST(ChangedValues, AreAllBeforeTheFirstFunction) {
  const TransferFunction function(mu_t_function({{0, 1}}));
  const ValueRange changed = changed_values(RangeExtremes(), function.extremes());
  EXPECT_EQ(changed.lower, -kInfinity);
  EXPECT_EQ(changed.upper, kInfinity);
}

TEST(ChangedValues, AreThoseAroundAMovedPoint) {
  const TransferFunction a(mu_t_function({{0, 0}, {100, 0}, {200, 1}, {300, 0}, {400, 2}}));
  const TransferFunction b(mu_t_function({{0, 0}, {100, 0}, {210, 1}, {300, 0}, {400, 2}}));
  const ValueRange changed = changed_values(a.extremes(), b.extremes());
  EXPECT_EQ(changed.lower, 100);
  EXPECT_EQ(changed.upper, 300);
}

}  // namespace
}  // namespace voxlume
