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

/// In the place of a block's word: the block is not joined. No level is as high.
inline constexpr std::uint32_t kNotJoined = ~std::uint32_t{0};

/// A block of cells while it is decided whether it is joined.
struct Block {
  float mu_maj = 0;  ///< 1/mm
  float cost = 1;    ///< of a random line through it, in cell crossings
};

/// What crossing one level's blocks costs.
struct JoinRule {
  float lookup_cost;  ///< in cell crossings
  float chord_mm;     ///< mean length of a random line through a block of the level

  float cost(float mu_maj) const { return 1.0f + lookup_cost * chord_mm * mu_maj; }
};

/// A cube of 8^3 parts, each a finest cell or itself a cube, and the blocks of 2^3, 4^3 and 8^3 of them. A
/// block is joined where crossing it as a whole costs no more than crossing its parts. A part beyond the grid
/// counts as an empty one.
class BlockCube {
 public:
  static constexpr int kLevels = 3;
  static constexpr int kSide = 1 << kLevels;
  static constexpr int kParts = kSide * kSide * kSide;
  static constexpr int at(int i, int j, int k) { return (k * kSide + j) * kSide + i; }

  alignas(64) std::array<float, kParts> mu_maj;  ///< of the parts
  alignas(64) std::array<float, kParts> cost;    ///< of the parts

  /// Joins parts of `level` whose chord is chord_mm to blocks of 2^max_level cells at most.
  void join(float lookup_cost, float chord_mm, int level, int max_level) {
    const auto word_level = [&](int up) { return level + up <= max_level ? level + up : -1; };
    join_level<4>(mu_maj.data(), cost.data(), {lookup_cost, 2 * chord_mm}, word_level(1), level_1_);
    join_level<2>(level_1_.mu_maj.data(), level_1_.cost.data(), {lookup_cost, 4 * chord_mm}, word_level(2),
                  level_2_);
    join_level<1>(level_2_.mu_maj.data(), level_2_.cost.data(), {lookup_cost, 8 * chord_mm}, word_level(3),
                  level_3_);
    spread<1>(level_3_, level_2_);
    spread<2>(level_2_, level_1_);
  }

  Block top() const { return {level_3_.mu_maj[0], level_3_.cost[0]}; }
  /// The word of the cube as a whole, or kNotJoined.
  std::uint32_t top_word() const { return level_3_.words[0]; }
  /// The word of the largest joined block that a part is in; kNotJoined where it stands alone.
  std::uint32_t joined_word(int i, int j, int k) const {
    return level_1_.words[((k >> 1) * (kSide / 2) + (j >> 1)) * (kSide / 2) + (i >> 1)];
  }

 private:
  template <int n>
  struct Level {
    alignas(64) std::array<float, n * n * n> mu_maj, cost;
    std::array<std::uint32_t, n * n * n> words;
  };

  /// `word_level` is negative where blocks of this level are not allowed.
  template <int n>
  static void join_level(const float* part_maj, const float* part_cost, const JoinRule& rule, int word_level,
                         Level<n>& out) {
    constexpr int kRow = 2 * n, kPlane = kRow * kRow;
    for (int k = 0, block = 0; k < n; ++k)
      for (int j = 0; j < n; ++j) {
        const float *m = part_maj + 2 * k * kPlane + 2 * j * kRow, *c = part_cost + (m - part_maj);
        float row_maj[kRow], row_cost[kRow];
        for (int i = 0; i < kRow; ++i) {
          row_maj[i] = std::max(std::max(m[i], m[kRow + i]), std::max(m[kPlane + i], m[kPlane + kRow + i]));
          row_cost[i] = (c[i] + c[kRow + i]) + (c[kPlane + i] + c[kPlane + kRow + i]);
        }
        for (int i = 0; i < n; ++i, ++block) {
          const float majorant = std::max(row_maj[2 * i], row_maj[2 * i + 1]);
          // A random line through a block crosses each of its 8 parts with probability 1/4, the ratio of
          // their areas.
          const float parts = 0.25f * (row_cost[2 * i] + row_cost[2 * i + 1]);
          const float whole = rule.cost(majorant);
          const bool joined = (whole <= parts) & (word_level >= 0);
          out.mu_maj[block] = majorant;
          out.cost[block] = joined ? whole : parts;
          out.words[block] = joined ? make_word(majorant, word_level) : kNotJoined;
        }
      }
  }

  /// Gives the blocks inside a joined block its word.
  template <int n>
  static void spread(const Level<n>& from, Level<2 * n>& to) {
    for (int k = 0, block = 0; k < 2 * n; ++k)
      for (int j = 0; j < 2 * n; ++j)
        for (int i = 0; i < 2 * n; ++i, ++block) {
          const std::uint32_t word = from.words[((k >> 1) * n + (j >> 1)) * n + (i >> 1)];
          to.words[block] = word == kNotJoined ? to.words[block] : word;
        }
  }

  Level<4> level_1_;
  Level<2> level_2_;
  Level<1> level_3_;
};

}  // namespace voxlume
