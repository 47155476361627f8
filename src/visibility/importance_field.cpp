#include "visibility/importance_field.h"

#include <fmt/format.h>

#include <utility>

#include "base/fail.h"
#include "base/memory.h"
#include "visibility/importance_voxels.h"

namespace voxlume {
namespace {

/// Cells of 2 voxels know of most points, and look-ups take less time than with cells of 4 or 8; there are no
/// more than this many.
constexpr std::uint64_t kMostCells = 1u << 24;

int cell_side(const GridView& grid) {
  int side = 2;
  const auto cells = [&](int a) { return static_cast<std::uint64_t>(grid.size[a] / side + 1); };
  while (cells(0) * cells(1) * cells(2) > kMostCells) side *= 2;
  return side;
}

void check_memory(const GridView& grid, ImportanceLookup lookup) {
  const std::uint64_t copies = lookup == ImportanceLookup::kSmoothed ? 2 : 1;
  const std::uint64_t bytes = static_cast<std::uint64_t>(grid.size[0]) *
                              static_cast<std::uint64_t>(grid.size[1]) *
                              static_cast<std::uint64_t>(grid.size[2]) * sizeof(std::uint16_t) * copies;
  const std::uint64_t available = available_memory_bytes();
  if (bytes > available)
    fail(ErrorCode::kOutOfMemory, "/visibility/lookup",
         fmt::format("the importance of voxels needs {:.1f} GB of memory; {:.1f} GB are available",
                     static_cast<double>(bytes) * 1e-9, static_cast<double>(available) * 1e-9));
}

}  // namespace

ImportanceField::ImportanceField(std::vector<ImportanceRule> rules, std::span<const RuleVolume> volumes,
                                 ImportanceLookup lookup)
    : rules_(std::move(rules)) {
  view_.rule_count = static_cast<std::int32_t>(rules_.size());
  for (std::size_t i = 0; i < volumes.size(); ++i) view_.volumes[i] = volumes[i].view;
  const GridView& main = volumes[0].view.grid;
  cells_.emplace(rules_, volumes, cell_side(main));
  if (lookup == ImportanceLookup::kInterpolated) return;
  check_memory(main, lookup);
  voxels_ = importance_of_voxels(view());
  if (lookup == ImportanceLookup::kSmoothed) voxels_ = mean_of_neighbours(voxels_, main.size);
  view_.lookup = lookup;
  view_.voxels = main;
  view_.voxels.type = VoxelType::kU16;
  view_.voxels.voxels = voxels_.data();
  cells_.emplace(rules_, view_.voxels, cell_side(main));
}

ImportanceView ImportanceField::view() const {
  ImportanceView out = view_;
  out.rules = rules_.data();
  out.cells = cells_->view();
  return out;
}

}  // namespace voxlume
