#include "scene/label_values.h"

#include <fmt/format.h>

#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

/// Which of the possible labels occur; any thread may add.
class LabelSet {
 public:
  void add(double label) {
    const auto index = static_cast<std::size_t>(label + kMostLabel);
    std::atomic<bool>& seen = seen_[index];
    if (!seen.load(std::memory_order_relaxed)) seen.store(true, std::memory_order_relaxed);
  }
  std::vector<float> ascending() const {
    std::vector<float> out;
    for (std::size_t index = 0; index < seen_.size(); ++index)
      if (seen_[index]) out.push_back(static_cast<float>(index) - kMostLabel);
    return out;
  }

 private:
  std::vector<std::atomic<bool>> seen_ =
      std::vector<std::atomic<bool>>(2 * static_cast<std::size_t>(kMostLabel) + 1);
};

}  // namespace

std::vector<float> label_values(const GridView& grid, const std::string& where) {
  LabelSet labels;
  with_voxels(grid.type, grid.voxels, [&](const auto* voxels) {
    parallel_for(grid.size[2], 1, [&](std::int64_t k) {
      const auto* const slice = voxels + k * grid.stride_k;
      for (std::int64_t i = 0; i < grid.stride_k; ++i) {
        if (i > 0 && slice[i] == slice[i - 1]) continue;  // as most are
        const auto v = static_cast<double>(slice[i]);
        if (!std::isfinite(v)) continue;
        if (v != std::floor(v))
          throw Error(ErrorCode::kBadFormat, where,
                      "expected a label volume of whole numbers, found fractions");
        if (std::abs(v) > kMostLabel)
          throw Error(ErrorCode::kBadFormat, where,
                      fmt::format("expected labels from {} to {}, found {}", -kMostLabel, kMostLabel, v));
        labels.add(v);
      }
    });
  });
  return labels.ascending();
}

}  // namespace voxlume
