#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "visibility/importance_cells.h"

namespace voxlume {

/// What is important in a volume. Owns what view() points to, but for the voxels of the volumes.
class ImportanceField {
 public:
  /// `volumes`, the main one first, are those that the rules name. On all threads. Throws Error kOutOfMemory
  /// where voxels are to be kept and there is no room for them.
  ImportanceField(std::vector<ImportanceRule> rules, std::span<const RuleVolume> volumes,
                  ImportanceLookup lookup);
  ImportanceField(ImportanceField&&) = default;
  ImportanceField& operator=(ImportanceField&&) = default;

  ImportanceView view() const;

 private:
  std::vector<ImportanceRule> rules_;
  ImportanceView view_;
  std::vector<std::uint16_t> voxels_;
  std::optional<ImportanceCells> cells_;
};

}  // namespace voxlume
