#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "accel/hierarchy_view.h"

namespace voxlume {

/// The smallest word of HierarchyView whose majorant is at least mu_maj [1/mm].
inline std::uint32_t make_word(float mu_maj, int level) {
  return ((std::bit_cast<std::uint32_t>(mu_maj) + kLevelMask) & ~kLevelMask) |
         static_cast<std::uint32_t>(level);
}

/// A block of cells while it is decided whether it is joined.
struct Block {
  float mu_maj = 0;     ///< 1/mm
  float cost = 0;       ///< of a random line through it, in cell crossings; 0 outside the grid
  bool joined = false;  ///< cheaper as a whole than in parts
};

/// What one level's blocks cost.
struct JoinRule {
  float lookup_cost;  ///< in cell crossings
  float chord_mm;     ///< mean length of a random line through a block of the level

  Block whole(float mu_maj) const { return {mu_maj, 1.0f + lookup_cost * mu_maj * chord_mm, true}; }
  /// A random line through a block crosses each of its 8 parts with probability 1/4, the ratio of their
  /// areas.
  Block join(float mu_maj, float parts_cost) const {
    if (parts_cost == 0) return {};
    const Block block = whole(mu_maj);
    const float parts = 0.25f * parts_cost;
    return block.cost <= parts ? block : Block{mu_maj, parts, false};
  }
};

/// A cube of 8^3 parts, each a finest cell or itself a cube, and the blocks of 2^3, 4^3 and 8^3 of them.
class BlockCube {
 public:
  static constexpr int kLevels = 3;
  static constexpr int kSide = 1 << kLevels;

  Block& part(int i, int j, int k) { return parts_[(k * kSide + j) * kSide + i]; }
  const Block& top() const { return level_3_; }

  /// Joins parts whose chord is chord_mm up to blocks of 2^max_level a side.
  void join(float lookup_cost, float chord_mm, int max_level) {
    join_level<4>(parts_.data(), level_1_.data(), {lookup_cost, 2 * chord_mm}, max_level >= 1);
    join_level<2>(level_1_.data(), level_2_.data(), {lookup_cost, 4 * chord_mm}, max_level >= 2);
    join_level<1>(level_2_.data(), &level_3_, {lookup_cost, 8 * chord_mm}, max_level >= 3);
  }

  /// The level of the largest joined block that a part is in, 0 when it stands alone.
  int level_of(int i, int j, int k) const {
    return level_3_.joined ? 3 : block(2, i, j, k).joined ? 2 : block(1, i, j, k).joined ? 1 : 0;
  }
  /// The block of `level` that a part is in.
  const Block& block(int level, int i, int j, int k) const {
    const int n = kSide >> level, at = ((k >> level) * n + (j >> level)) * n + (i >> level);
    return level == 0 ? parts_[at] : level == 1 ? level_1_[at] : level == 2 ? level_2_[at] : level_3_;
  }

 private:
  template <int n>
  static void join_level(const Block* parts, Block* out, const JoinRule& rule, bool allowed) {
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          float mu_maj = 0, cost = 0;
          for (int p = 0; p < 8; ++p) {
            const Block& b =
                parts[((2 * k + (p >> 2)) * 2 * n + 2 * j + (p >> 1 & 1)) * 2 * n + 2 * i + (p & 1)];
            mu_maj = std::max(mu_maj, b.mu_maj);
            cost += b.cost;
          }
          *out = rule.join(mu_maj, cost);
          out++->joined &= allowed;
        }
  }

  std::array<Block, 512> parts_;
  std::array<Block, 64> level_1_;
  std::array<Block, 8> level_2_;
  Block level_3_;
};

}  // namespace voxlume
