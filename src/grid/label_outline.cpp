#include "grid/label_outline.h"

#include <bit>
#include <type_traits>

#include "base/parallel.h"
#include "grid/label_kernel.h"

namespace voxlume {
namespace {

/// Weights below this share of the kernel's are left out.
constexpr float kLeastWeight = 1e-3f;
/// Leads are stored in steps of 1 / kLeadSteps.
constexpr float kLeadSteps = 140;
/// What is thinner than the kernel is outvoted in the smoothed field. Its voxels get kLeastLead at the least,
/// and more the smaller their share is. Found by trial: plates, bars and tubes of 1 to 3 voxels then keep
/// about their volume, and voxels at the rim of round bodies do not stand out.
constexpr float kLeastLead = 0.05f, kThinLead = 3.5f, kSlightlyThin = 0.1f;
/// The four voxels on one side of a point, of the least lead, hold against those on the other, of the
/// greatest: each of four labels may have no more votes than all after it, 1, 2, 4 and 8 times the last's.
static_assert(15 * 255 * kLeastVote < 0.99 * kLeastLead * kLeadSteps * (1 - kLeastVote));

template <class T>
bool same(T a, T b) noexcept {
  if constexpr (std::is_floating_point_v<T>) return a == b || (a != a && b != b);
  return a == b;
}

/// The order in which labels are compared with all after them; NaN is the first.
template <class T>
bool comes_before(T a, T b) noexcept {
  return a < b || (a != a && b == b);
}

/// Equal for the same label.
template <class T>
std::uint32_t key_of(T label) noexcept {
  if constexpr (!std::is_floating_point_v<T>) return static_cast<std::uint32_t>(label);
  const float value = static_cast<float>(label) + 0.0f;  // no negative zero
  return value == value ? std::bit_cast<std::uint32_t>(value) : ~0u;
}

/// Shares of labels under a kernel around a voxel: of its own, and of others.
template <class T>
class Shares {
 public:
  void start(T own) {
    own_ = {own, 0};
    other_.share = 0;
    ++round_;
    used_.clear();
  }
  void add(T label, float share) {
    if (same(label, own_.label)) {
      own_.share += share;
    } else if (other_.share == 0 || same(label, other_.label)) {
      other_.label = label;
      other_.share += share;
    } else {
      slot_of(label).share += share;
    }
  }

  /// The voxel's lead, in steps.
  std::uint8_t lead() const {
    Label rival = other_;
    for (const std::uint32_t at : used_)
      if (slots_[at].share > rival.share) rival = slots_[at];
    float ahead = ahead_of_later(own_);
    if (comes_before(rival.label, own_.label)) ahead = std::min(ahead, -ahead_of_later(rival));
    const float lacks = std::max(-0.5f * ahead, 0.0f);
    const float raised = kLeastLead + kThinLead * rival.share *
                                          (lacks < kSlightlyThin ? lacks * lacks / kSlightlyThin : lacks);
    return static_cast<std::uint8_t>(std::lround(std::min(std::max(ahead, raised) * kLeadSteps, 255.0f)));
  }

 private:
  struct Label {
    T label{};
    float share = 0;
  };
  struct Slot : Label {
    std::uint32_t round = 0;
  };
  /// More than there are voxels under the kernel.
  static constexpr std::uint32_t kSlots = 2048;
  static_assert(kSlots > kMostLabelTaps * kMostLabelTaps * kMostLabelTaps);

  /// How far a label is ahead of all those together that come after it, of 1.
  float ahead_of_later(const Label& label) const {
    float later = 0;
    const auto count = [&](const Label& other) {
      if (comes_before(label.label, other.label)) later += other.share;
    };
    count(own_);
    count(other_);
    for (const std::uint32_t at : used_) count(slots_[at]);
    return (label.share - later) / (label.share + later);
  }

  Slot& slot_of(T label) {
    std::uint32_t at = key_of(label) * 2654435761u >> 21;
    while (slots_[at].round == round_ && !same(slots_[at].label, label)) at = (at + 1) % kSlots;
    if (slots_[at].round != round_) {
      slots_[at] = {{label, 0}, round_};
      used_.push_back(at);
    }
    return slots_[at];
  }

  Label own_, other_;
  std::uint32_t round_ = 0;
  std::vector<Slot> slots_ = std::vector<Slot>(kSlots);
  std::vector<std::uint32_t> used_;  ///< slots of this round
};

/// The kernel around a voxel's centre, along one axis; the weights add up to 1.
struct CenterTaps {
  int reach = 0;  ///< voxels -reach .. reach
  float weight[kMostLabelTaps] = {};

  explicit CenterTaps(float kernel_reach) {
    while (reach < kMostLabelTaps / 2 &&
           label_weight(static_cast<float>(reach + 1), kernel_reach) > kLeastWeight)
      ++reach;
    float sum = 0;
    for (int n = 0; n <= 2 * reach; ++n)
      sum += weight[n] = label_weight(static_cast<float>(n - reach), kernel_reach);
    for (float& w : weight) w /= sum;
  }
};

template <class T>
class LeadFinder {
 public:
  LeadFinder(const T* voxels, const GridView& grid, std::uint8_t* leads)
      : voxels_(voxels), grid_(grid), leads_(leads) {
    const Vec3f reach = label_kernel_reach(grid);
    for (int a = 0; a < 3; ++a) taps_[a] = CenterTaps(reach[a]);
  }

  void find_row(std::int32_t j, std::int32_t k, Shares<T>& shares) const {
    const std::int64_t first = j * grid_.stride_j + k * grid_.stride_k;
    mark_borders(j, k, leads_ + first);
    for (std::int32_t i = 0; i < grid_.size[0]; ++i)
      if (leads_[first + i]) leads_[first + i] = find(i, j, k, shares);
  }

 private:
  std::int64_t clamped(std::int32_t at, int axis) const { return std::clamp(at, 0, grid_.size[axis] - 1); }
  const T* row_at(std::int32_t j, std::int32_t k) const {
    return voxels_ + clamped(j, 1) * grid_.stride_j + clamped(k, 2) * grid_.stride_k;
  }

  /// 1 where one of the 26 neighbours has another label, else 0.
  void mark_borders(std::int32_t j, std::int32_t k, std::uint8_t* out) const {
    const T* own = row_at(j, k);
    const std::int32_t n = grid_.size[0];
    std::fill_n(out, n, std::uint8_t{0});
    for (std::int32_t dk = -1; dk <= 1; ++dk)
      for (std::int32_t dj = -1; dj <= 1; ++dj) {
        const T* row = row_at(j + dj, k + dk);
        for (std::int32_t i = 0; i < n; ++i) out[i] |= !same(row[i], own[i]);
        for (std::int32_t i = 0; i + 1 < n; ++i) out[i] |= !same(row[i + 1], own[i]);
        for (std::int32_t i = 1; i < n; ++i) out[i] |= !same(row[i - 1], own[i]);
      }
  }

  std::uint8_t find(std::int32_t i, std::int32_t j, std::int32_t k, Shares<T>& shares) const {
    const auto& [along_i, along_j, along_k] = taps_;
    std::int64_t offset[kMostLabelTaps];
    const int count = 2 * along_i.reach + 1;
    for (int n = 0; n < count; ++n) offset[n] = clamped(i + n - along_i.reach, 0);
    shares.start(row_at(j, k)[i]);
    for (int dk = -along_k.reach; dk <= along_k.reach; ++dk)
      for (int dj = -along_j.reach; dj <= along_j.reach; ++dj) {
        const T* row = row_at(j + dj, k + dk);
        const float row_weight = along_k.weight[dk + along_k.reach] * along_j.weight[dj + along_j.reach];
        T label = row[offset[0]];
        float run = along_i.weight[0];
        for (int n = 1; n < count; ++n) {
          const T next = row[offset[n]];
          if (!same(next, label)) {
            shares.add(label, row_weight * run);
            label = next;
            run = 0;
          }
          run += along_i.weight[n];
        }
        shares.add(label, row_weight * run);
      }
    return shares.lead();
  }

  const T* voxels_;
  const GridView& grid_;
  std::uint8_t* leads_;
  CenterTaps taps_[3] = {CenterTaps(1), CenterTaps(1), CenterTaps(1)};
};

/// Of eight voters' labels the first, in order, that has more votes than all after it together. (By the most
/// votes, there would be grooves in a surface along the borders of the labels below it.)
template <class T>
T first_ahead(const T (&voters)[8], const float (&votes)[8]) noexcept {
  T labels[8];
  float sums[8], after[9];
  int count = 0;
  for (int voter = 0; voter < 8; ++voter) {
    int n = 0;
    while (n < count && !same(labels[n], voters[voter])) ++n;
    if (n == count) {
      for (++count; n > 0 && comes_before(voters[voter], labels[n - 1]); --n) {
        labels[n] = labels[n - 1];
        sums[n] = sums[n - 1];
      }
      labels[n] = voters[voter];
      sums[n] = 0;
    }
    sums[n] += votes[voter];
  }
  after[count] = 0;
  for (int n = count; n-- > 0;) after[n] = after[n + 1] + sums[n];
  int n = 0;
  while (n + 1 < count && !(sums[n] > after[n + 1])) ++n;
  return labels[n];
}

/// Bit n: voter n has the label.
template <class T>
unsigned voters_of(T label, const T (&voters)[8]) noexcept {
  unsigned bits = 0;
  for (int n = 0; n < 8; ++n) bits |= static_cast<unsigned>(same(voters[n], label)) << n;
  return bits;
}

/// The eight voxels around a point: bit 0 of their number is their place along i, bit 1 along j, bit 2 along
/// k.
struct Neighbours {
  std::int64_t at[8];
  float share[3];  ///< of the upper ones, along each axis

  Neighbours(const GridView& grid, Vec3f p_index) noexcept {
    std::int64_t base = 0, next[3];
    const std::int64_t stride[3] = {1, grid.stride_j, grid.stride_k};
    for (int a = 0; a < 3; ++a) {
      const float p = std::clamp(p_index[a], 0.0f, static_cast<float>(grid.size[a] - 1));
      const std::int32_t i = std::min(static_cast<std::int32_t>(p), std::max(grid.size[a] - 2, 0));
      share[a] = p - static_cast<float>(i);
      base += i * stride[a];
      next[a] = i + 1 < grid.size[a] ? stride[a] : 0;
    }
    for (int n = 0; n < 8; ++n)
      at[n] = base + (n & 1 ? next[0] : 0) + (n & 2 ? next[1] : 0) + (n & 4 ? next[2] : 0);
  }

  float weight(int n) const noexcept {
    return (n & 1 ? share[0] : 1 - share[0]) * (n & 2 ? share[1] : 1 - share[1]) *
           (n & 4 ? share[2] : 1 - share[2]);
  }
  float interpolate(const float (&v)[8]) const noexcept {
    const auto between = [](float a, float b, float t) { return a + t * (b - a); };
    const float v0 = between(between(v[0], v[1], share[0]), between(v[2], v[3], share[0]), share[1]);
    const float v1 = between(between(v[4], v[5], share[0]), between(v[6], v[7], share[0]), share[1]);
    return between(v0, v1, share[2]);
  }
};

template <class T>
T vote(const T* voxels, const std::uint8_t* leads, const Neighbours& around) noexcept {
  T voters[8];
  for (int n = 0; n < 8; ++n) voters[n] = voxels[around.at[n]];
  const T a = voters[0];
  const unsigned of_a = voters_of(a, voters);
  if (of_a == 255) return a;
  const T b = voters[std::countr_one(of_a)];
  float votes[8];
  if ((of_a | voters_of(b, voters)) != 255) {
    for (int n = 0; n < 8; ++n) votes[n] = around.weight(n) * static_cast<float>(leads[around.at[n]]);
    return first_ahead(voters, votes);
  }
  for (int n = 0; n < 8; ++n) {
    const int lead = leads[around.at[n]];
    votes[n] = static_cast<float>(of_a >> n & 1 ? lead : -lead);
  }
  const float ahead = around.interpolate(votes);
  return ahead > 0 ? a : ahead < 0 ? b : comes_before(a, b) ? b : a;
}

}  // namespace

std::vector<std::uint8_t> label_leads(const GridView& labels) {
  constexpr std::int64_t kRowsAtOnce = 64;
  std::vector<std::uint8_t> leads(static_cast<std::size_t>(labels.stride_k * labels.size[2]));
  const std::int64_t rows = std::int64_t{labels.size[1]} * labels.size[2];
  with_voxels(labels.type, labels.voxels, [&](const auto* voxels) {
    using T = std::remove_cvref_t<decltype(*voxels)>;
    const LeadFinder<T> finder(voxels, labels, leads.data());
    parallel_for((rows + kRowsAtOnce - 1) / kRowsAtOnce, 1, [&](std::int64_t task) {
      Shares<T> shares;
      for (std::int64_t row = task * kRowsAtOnce; row < std::min(rows, (task + 1) * kRowsAtOnce); ++row)
        finder.find_row(static_cast<std::int32_t>(row % labels.size[1]),
                        static_cast<std::int32_t>(row / labels.size[1]), shares);
    });
  });
  return leads;
}

float voted_label(const GridView& labels, const std::uint8_t* leads, Vec3f p_index) noexcept {
  const Neighbours around(labels, p_index);
  return with_voxels(labels.type, labels.voxels,
                     [&](const auto* voxels) { return static_cast<float>(vote(voxels, leads, around)); });
}

}  // namespace voxlume
