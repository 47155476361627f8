#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "base/fail.h"
#include "grid/cell_ranges.h"
#include "grid/cells_in_proxy.h"

namespace voxlume {
namespace {

/// The distinct labels of a few voxels, or of many.
class LabelCollector {
 public:
  /// The labels of the voxels of a box, sorted; valid until the next call.
  template <class T>
  std::span<const float> collect(const T* voxels, const GridView& grid, const VoxelBox& box) {
    labels_.clear();
    limit_ = kSearched;
    T last = voxels[box.first[0] + box.first[1] * grid.stride_j + box.first[2] * grid.stride_k];
    add(static_cast<float>(last));
    for (std::int32_t k = box.first[2]; k <= box.last[2]; ++k)
      for (std::int32_t j = box.first[1]; j <= box.last[1]; ++j) {
        const T* row = voxels + k * grid.stride_k + j * grid.stride_j;
        for (std::int32_t i = box.first[0]; i <= box.last[0]; ++i) {
          if (row[i] == last) continue;
          last = row[i];
          add(static_cast<float>(last));
        }
      }
    sort();
    return labels_;
  }

 private:
  static constexpr std::size_t kSearched = 32;

  void add(float label) {
    if (std::isnan(label)) return;
    label += 0.0f;  // no negative zero
    if (labels_.size() < kSearched && std::find(labels_.begin(), labels_.end(), label) != labels_.end())
      return;
    labels_.push_back(label);
    if (labels_.size() < limit_) return;
    sort();
    limit_ = std::max(kSearched, 2 * labels_.size());
  }

  void sort() {
    std::sort(labels_.begin(), labels_.end());
    labels_.erase(std::unique(labels_.begin(), labels_.end()), labels_.end());
  }

  std::vector<float> labels_;
  std::size_t limit_ = kSearched;
};

/// Sets of labels, each stored once, in the order in which they come.
class SetTable {
 public:
  SetTable() { id_of({}); }

  std::uint32_t id_of(std::span<const float> set) {
    if (!begin_.empty() && same(last_, set)) return last_;
    const std::uint64_t key = hash(set);
    const auto [found, end] = ids_.equal_range(key);
    for (auto at = found; at != end; ++at)
      if (same(at->second, set)) return last_ = at->second;
    if (begin_.empty()) begin_.push_back(0);
    if (labels_.size() + set.size() > std::numeric_limits<std::uint32_t>::max())
      fail(ErrorCode::kOutOfMemory, "",
           "the cells' sets of labels hold more than 4294967295 labels (noise?)");
    last_ = static_cast<std::uint32_t>(begin_.size() - 1);
    labels_.insert(labels_.end(), set.begin(), set.end());
    begin_.push_back(static_cast<std::uint32_t>(labels_.size()));
    ids_.emplace(key, last_);
    return last_;
  }

  std::uint32_t count() const { return static_cast<std::uint32_t>(begin_.size() - 1); }
  std::span<const float> set(std::uint32_t id) const {
    return {labels_.data() + begin_[id], labels_.data() + begin_[id + 1]};
  }
  void move_to(LabelSets& sets) {
    sets.begin = std::move(begin_);
    sets.labels = std::move(labels_);
  }

 private:
  bool same(std::uint32_t id, std::span<const float> other) const {
    const std::span<const float> own = set(id);
    return std::equal(own.begin(), own.end(), other.begin(), other.end());
  }

  // FNV-1a over words.
  static std::uint64_t hash(std::span<const float> set) {
    std::uint64_t h = 0xcbf29ce484222325u;
    for (const float label : set) h = (h ^ std::bit_cast<std::uint32_t>(label)) * 0x100000001b3u;
    return h ^ (h >> 29);
  }

  std::vector<std::uint32_t> begin_;
  std::vector<float> labels_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> ids_;
  std::uint32_t last_ = 0;
};

}  // namespace

LabelSets label_sets_over(const GridView& main, int cell_voxels, CellOrder order, const GridView& labels,
                          Outline outline) {
  constexpr std::int64_t kSlabBlocks = 16;
  const CellLayout layout(main, cell_voxels, order);
  const CellsInProxy cells(main, layout, labels);
  LabelSets sets;
  sets.set_of_cell.assign(static_cast<std::size_t>(layout.place_count()), 0);

  // Each slab numbers its own sets; going through the slabs in order then numbers all sets as one slab would.
  const std::int64_t blocks = layout.block_count(), slabs = (blocks + kSlabBlocks - 1) / kSlabBlocks;
  std::vector<SetTable> slab_sets(static_cast<std::size_t>(slabs));
  with_voxels(labels.type, labels.voxels, [&](const auto* voxels) {
    parallel_for(slabs, 1, [&](std::int64_t slab) {
      LabelCollector collector;
      SetTable table;
      const auto visit = [&](std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t count,
                             std::int64_t place) {
        for (std::int32_t x = 0; x < count; ++x) {
          const VoxelBox box =
              outline == Outline::kSmooth ? cells.voted(i + x, j, k) : cells.nearest(i + x, j, k);
          if (!box.empty()) sets.set_of_cell[place + x] = table.id_of(collector.collect(voxels, labels, box));
        }
      };
      for (std::int64_t b = slab * kSlabBlocks; b < std::min(blocks, (slab + 1) * kSlabBlocks); ++b)
        layout.each_run_of(b, visit);
      slab_sets[slab] = std::move(table);
    });
  });

  SetTable all;
  std::vector<std::vector<std::uint32_t>> number(static_cast<std::size_t>(slabs));
  for (std::size_t slab = 0; slab < number.size(); ++slab) {
    for (std::uint32_t id = 0; id < slab_sets[slab].count(); ++id)
      number[slab].push_back(all.id_of(slab_sets[slab].set(id)));
    slab_sets[slab] = {};
  }
  const std::int64_t slab_places = layout.place_count() / blocks * kSlabBlocks;
  parallel_for(slabs, 1, [&](std::int64_t slab) {
    const std::int64_t end = std::min(layout.place_count(), (slab + 1) * slab_places);
    for (std::int64_t place = slab * slab_places; place < end; ++place)
      sets.set_of_cell[place] = number[slab][sets.set_of_cell[place]];
  });
  all.move_to(sets);
  return sets;
}

}  // namespace voxlume
