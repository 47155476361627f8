// How fast a list of runs finds the integral of a step function with very narrow peaks (lerzer2025 Fig. 7): a
// row of CSV a pass.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sampling/rng.h"
#include "visibility/list_refiner.h"

using namespace voxlume;

namespace {

constexpr float kExit = 10, kInside = 5;
constexpr int kPasses = 512, kLooks = 48;

struct Peak {
  float begin, end, k;
};
constexpr Peak kPeaks[] = {{0.4f, 1.9f, 1},        {2.3f, 2.32f, 1},  {2.5f, 2.51f, 0.75f},
                           {3.1f, 3.105f, 1},      {4.2f, 4.203f, 1}, {5.6f, 6.7f, 0.5f},
                           {7.25f, 7.254f, 0.75f}, {8.0f, 8.03f, 1},  {9.2f, 9.21f, 0.5f}};

float importance(float t) {
  for (const Peak& p : kPeaks)
    if (t >= p.begin && t < p.end) return p.k;
  return 0;
}

/// The integral of the importance's square from 0 to t.
double exact(double t) {
  double sum = 0;
  for (const Peak& p : kPeaks) sum += double{p.k} * p.k * std::max(std::min(t, double{p.end}) - p.begin, 0.0);
  return sum;
}

}  // namespace

int main() {
  Rng rng(1, 0, 0, 0);
  ListRefiner refiner;
  std::vector<ImportanceSegment> list;
  fmt::print("pass,looks,segments,error,error_at_5\n");
  for (int pass = 0; pass < kPasses; ++pass) {
    refiner.refine(
        pass, 0, kExit, kLooks, importance, [&] { return rng.next(); }, list);
    const float total = integrate_segments(list, 0, kExit);
    const SegmentListView view{list.data(), static_cast<std::int32_t>(list.size()), 0, kExit, total};
    fmt::print("{},{},{},{:.3g},{:.3g}\n", pass + 1, (pass + 1) * kLooks, list.size(),
               std::abs(total - exact(kExit)), std::abs(importance_before(view, kInside) - exact(kInside)));
  }
}
