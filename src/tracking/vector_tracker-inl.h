// Included once for every instruction set by vector_tracker.cpp; hence no include guard of the usual kind.
#if defined(VOXLUME_TRACKING_VECTOR_TRACKER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_TRACKING_VECTOR_TRACKER_INL_H_
#undef VOXLUME_TRACKING_VECTOR_TRACKER_INL_H_
#else
#define VOXLUME_TRACKING_VECTOR_TRACKER_INL_H_
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <bit>

#include "base/voxel_type.h"
#include "grid/voxel_pairs-inl.h"
#include "sampling/vector_random-inl.h"
#include "tracking/lanes.h"
#include "transfer/vector_records-inl.h"
#include "transfer/vector_transfer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Tracks the lanes of one group, vector by vector. Every step computes what HierarchyWalk, sample_trilinear,
/// classify_mu_t and the trackers of tracking.cpp compute, in the same order, so that lanes and scalar code
/// agree to the last bit.
template <class Voxel>
class LaneTracker {
 public:
  LaneTracker(const Medium& medium, Lanes& lanes)
      : hierarchy_(medium.accelerator.hierarchy),
        grid_(medium.grid),
        transfer_(medium.transfer),
        medium_(medium),
        lanes_(lanes) {}

  void run() {
    // Crossings go on until this many of a vector's lanes wait for a look-up: look-ups cost the same for one.
    constexpr std::size_t kLookUps = (5 * kN + 7) / 8;
    constexpr std::size_t kDoneLanes = 8;
    constexpr std::size_t kVectors = Lanes::kCount / kN;
    Census census[kVectors];
    for (std::size_t i = 0; i < kVectors; ++i) {
      begin(i * kN);
      census[i] = {count(i * kN, Lanes::kCross), count(i * kN, Lanes::kLookUp), count(i * kN, Lanes::kDone)};
    }
    for (;;) {
      std::size_t done = 0, under_way = 0;
      bool full[kVectors];
      // The vectors take turns, so that one computes while the other waits for memory.
      for (std::size_t i = 0; i < kVectors; ++i) {
        Census& lanes = census[i];
        under_way += lanes.crossing + lanes.looking_up;
        full[i] = lanes.looking_up >= kLookUps || (lanes.looking_up > 0 && lanes.crossing == 0);
        if (lanes.crossing > 0 && !full[i]) cross(i * kN, lanes);
      }
      for (std::size_t i = 0; i < kVectors; ++i) {
        if (full[i]) look_up(i * kN, census[i]);
        done += census[i].done;
      }
      if (done >= kDoneLanes || under_way == 0) return;
    }
  }

 private:
  static constexpr hn::CappedTag<float, 16> kF{};
  static constexpr hn::RebindToSigned<decltype(kF)> kI{};
  static constexpr hn::RebindToUnsigned<decltype(kF)> kU{};
  static constexpr std::size_t kN = hn::MaxLanes(kF);
  using F = hn::Vec<decltype(kF)>;
  using I = hn::Vec<decltype(kI)>;
  using U = hn::Vec<decltype(kU)>;
  using MaskF = hn::Mask<decltype(kF)>;
  using MaskU = hn::Mask<decltype(kU)>;
  /// How many lanes of a vector are in which state.
  struct Census {
    std::size_t crossing, looking_up, done;
  };

  static F load(const Lanes::PerLane<float>& a, std::size_t v) { return hn::Load(kF, a.data() + v); }
  static I load(const Lanes::PerLane<std::int32_t>& a, std::size_t v) { return hn::Load(kI, a.data() + v); }
  static U load(const Lanes::PerLane<std::uint32_t>& a, std::size_t v) { return hn::Load(kU, a.data() + v); }
  static void store(F x, Lanes::PerLane<float>& a, std::size_t v) { hn::Store(x, kF, a.data() + v); }
  static void store(I x, Lanes::PerLane<std::int32_t>& a, std::size_t v) { hn::Store(x, kI, a.data() + v); }
  static void store(U x, Lanes::PerLane<std::uint32_t>& a, std::size_t v) { hn::Store(x, kU, a.data() + v); }
  template <class Vector, class Array>
  static void store_where(hn::Mask<hn::DFromV<Vector>> where, Vector x, Array& a, std::size_t v) {
    store(hn::IfThenElse(where, x, load(a, v)), a, v);
  }
  static MaskF to_f(MaskU m) { return hn::RebindMask(kF, m); }
  static MaskU to_u(MaskF m) { return hn::RebindMask(kU, m); }
  static hn::Mask<decltype(kI)> to_i(MaskF m) { return hn::RebindMask(kI, m); }

  MaskU in_state(std::size_t v, Lanes::State state) const {
    return hn::Eq(load(lanes_.state, v), hn::Set(kU, state));
  }
  std::size_t count(std::size_t v, Lanes::State state) const { return hn::CountTrue(kU, in_state(v, state)); }
  void set_state(MaskU where, Lanes::State state, std::size_t v) {
    store_where(where, hn::Set(kU, state), lanes_.state, v);
  }

  void move_on(MaskU where, Lanes::State state, std::size_t v, std::size_t& from, std::size_t& to) {
    set_state(where, state, v);
    const std::size_t moved = hn::CountTrue(kU, where);
    from -= moved;
    to += moved;
  }

  /// Rng::next() of the lanes in `where`; the others' streams stay.
  F draw(MaskU where, std::size_t v) {
    VectorRng<decltype(kF)> rng{load(lanes_.rng[0], v), load(lanes_.rng[1], v), load(lanes_.rng[2], v),
                                load(lanes_.rng[3], v)};
    const F u = rng.next(kF);
    store_where(where, rng.s0, lanes_.rng[0], v);
    store_where(where, rng.s1, lanes_.rng[1], v);
    store_where(where, rng.s2, lanes_.rng[2], v);
    store_where(where, rng.s3, lanes_.rng[3], v);
    return u;
  }

  /// `given` where it is not negative, and numbers drawn for the rest of `where`.
  F given_or_drawn(MaskF where, const Lanes::PerLane<float>& given, std::size_t v) {
    const F u = load(given, v);
    const MaskF draws = hn::And(where, hn::Lt(u, hn::Zero(kF)));
    return hn::AllFalse(kF, draws) ? u : hn::IfThenElse(draws, draw(to_u(draws), v), u);
  }

  /// sample_optical_depth.
  static F optical_depth(F u) { return vector_negative_log(kF, hn::Sub(hn::Set(kF, 1.0f), u)); }

  /// The majorant of a hierarchy's cell.
  static F majorant(U word) { return hn::BitCast(kF, hn::AndNot(hn::Set(kU, kLevelMask), word)); }

  I cell_of(F p) const {
    const F at = hn::Add(hn::Mul(p, hn::Set(kF, hierarchy_.cells_per_voxel)), hn::Set(kF, 1.0f));
    return hn::Sub(hn::ConvertTo(kI, at), hn::Set(kI, 1));
  }

  /// make_hierarchy_ray, HierarchyWalk's constructor and the first optical depth.
  void begin(std::size_t v) {
    const MaskU where = in_state(v, Lanes::kStart);
    if (hn::AllFalse(kU, where)) return;
    const MaskF where_f = to_f(where);
    F length = load(lanes_.length_mm, v);
    I cell[3];
    for (int a = 0; a < 3; ++a) {
      const F lower = hn::Set(kF, hierarchy_.domain.lower[a]),
              upper = hn::Set(kF, hierarchy_.domain.upper[a]);
      const F d = load(lanes_.direction[a], v), still = hn::Set(kF, kStillDirection);
      const F given = load(lanes_.origin[a], v);
      const F o = hn::Min(hn::Max(given, lower), upper);
      const MaskF upward = hn::Not(hn::Lt(d, hn::Neg(still)));
      const MaskF moves = hn::Gt(hn::Abs(d), still);
      const F inverse =
          hn::IfThenElse(moves, hn::Div(hn::Set(kF, 1.0f), d), hn::Set(kF, 1.0f / kStillDirection));
      length = hn::Min(length, hn::Mul(hn::Sub(hn::IfThenElse(upward, upper, lower), o), inverse));
      cell[a] = hn::Min(hn::Max(cell_of(o), hn::Set(kI, -1)), hn::Set(kI, hierarchy_.count[a]));
      store_where(where_f, o, lanes_.origin[a], v);
      store_where(where_f, inverse, lanes_.inverse[a], v);
      store_where(to_i(where_f), cell[a], lanes_.next_cell[a], v);
    }
    prefetch_next_word(where_f, cell, v);
    store_where(where_f, length, lanes_.length_mm, v);
    // collision_threshold; shadow rays have one to begin with.
    const MaskF flight = hn::And(where_f, to_f(hn::Eq(load(lanes_.is_shadow, v), hn::Zero(kU))));
    const F u_collision = given_or_drawn(flight, lanes_.u_collision, v);
    const F threshold =
        hn::IfThenElse(flight, hn::Sub(hn::Set(kF, 1.0f), u_collision), hn::Set(kF, kRouletteTransmittance));
    store_where(where_f, threshold, lanes_.threshold, v);
    store_where(where_f, optical_depth(given_or_drawn(where_f, lanes_.u_depth, v)), lanes_.tau, v);
    for (auto* zero : {&lanes_.mu_maj, &lanes_.run_mm, &lanes_.exit_mm, &lanes_.entered_mm})
      store_where(where_f, hn::Zero(kF), *zero, v);
    store_where(where_f, hn::Set(kF, 1.0f), lanes_.transmittance, v);
    store_where(to_i(where_f), hn::Set(kI, -1), lanes_.fetched[0], v);
    if (medium_.shadow_extinction != 1) {
      const F scale = hn::Set(kF, medium_.shadow_extinction);
      for (auto* rate : {&lanes_.rate_in_matter, &lanes_.rate_elsewhere})
        store_where(hn::AndNot(flight, where_f), hn::Mul(load(*rate, v), scale), *rate, v);
    }
    store_where(where_f, load(lanes_.rate_elsewhere, v), lanes_.rate, v);
    set_state(where, Lanes::kCross, v);
  }

  /// Notes where the words of the next cells are, and has them fetched well before they are needed: a gather
  /// would wait for them.
  void prefetch_next_word(MaskF where, const I (&cell)[3], std::size_t v) {
    const I at = hn::Add(hn::Add(hn::Mul(cell[2], hn::Set(kI, hierarchy_.stride_k)),
                                 hn::Mul(cell[1], hn::Set(kI, hierarchy_.stride_j))),
                         cell[0]);
    store_where(to_i(where), at, lanes_.next_word_at, v);
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(kF, where, bytes);
    for (std::uint32_t bits = bytes[0] | bytes[1] << 8; bits; bits &= bits - 1)
      hwy::Prefetch(hierarchy_.words +
                    lanes_.next_word_at[v + static_cast<std::size_t>(std::countr_zero(bits))]);
  }

  /// Leaves the block that a lane is in and enters the next: HierarchyWalk::next.
  void cross(std::size_t v, Census& census) {
    const MaskU where = in_state(v, Lanes::kCross);
    const MaskF where_f = to_f(where);
    const F left =
        hn::Sub(load(lanes_.tau, v),
                hn::Mul(hn::Sub(load(lanes_.run_mm, v), load(lanes_.entered_mm, v)), load(lanes_.mu_maj, v)));
    const F tau = hn::Max(left, hn::Zero(kF));
    const F start = load(lanes_.exit_mm, v), length = load(lanes_.length_mm, v);
    const MaskF ends = hn::Not(hn::Lt(start, length));

    const I cell[3] = {load(lanes_.next_cell[0], v), load(lanes_.next_cell[1], v),
                       load(lanes_.next_cell[2], v)};
    const U word =
        hn::GatherIndex(kU, hierarchy_.words,
                        hn::IfThenElseZero(to_i(hn::AndNot(ends, where_f)), load(lanes_.next_word_at, v)));
    const U level = hn::And(word, hn::Set(kU, kLevelMask));
    const F mu_maj = hn::Mul(majorant(word), load(lanes_.rate, v));
    const I size = hn::BitCast(kI, hn::Shl(hn::Set(kU, 1), level)), mask = hn::Neg(size);

    const F edge = hn::Set(kF, hierarchy_.cell_voxels);
    I first[3];
    F crossing[3];
    MaskF upward[3];
    for (int a = 0; a < 3; ++a) {
      first[a] = hn::And(cell[a], mask);
      const F inverse = load(lanes_.inverse[a], v);
      upward[a] = hn::Gt(inverse, hn::Zero(kF));
      const I ahead = hn::Add(first[a], hn::IfThenElseZero(to_i(upward[a]), size));
      const F plane = hn::Mul(hn::ConvertTo(kF, ahead), edge);
      crossing[a] = hn::Mul(hn::Sub(plane, load(lanes_.origin[a], v)), inverse);
    }
    const MaskF x_first = hn::And(hn::Lt(crossing[0], crossing[1]), hn::Lt(crossing[0], crossing[2]));
    const MaskF y_first = hn::AndNot(hn::Lt(crossing[0], crossing[1]), hn::Lt(crossing[1], crossing[2]));
    const MaskF axis[3] = {x_first, y_first, hn::Not(hn::Or(x_first, y_first))};
    const F nearest = hn::Min(hn::Min(crossing[0], crossing[1]), crossing[2]);
    const F exit = hn::Max(start, hn::Min(nearest, length));
    const F run = hn::Sub(exit, start);
    const I one = hn::Set(kI, 1);
    I next[3];
    for (int a = 0; a < 3; ++a) {
      const F p = hn::Add(load(lanes_.origin[a], v), hn::Mul(load(lanes_.direction[a], v), exit));
      const I inside = hn::Min(hn::Max(cell_of(p), first[a]), hn::Sub(hn::Add(first[a], size), one));
      const I beyond = hn::IfThenElse(to_i(upward[a]), hn::Add(first[a], size), hn::Sub(first[a], one));
      next[a] = hn::IfThenElse(to_i(axis[a]), beyond, inside);
      store_where(to_i(where_f), next[a], lanes_.next_cell[a], v);
      store_where(to_i(where_f), first[a], lanes_.cell[a], v);
    }
    prefetch_next_word(hn::And(where_f, hn::Lt(exit, length)), next, v);
    const F entered = hn::Div(tau, mu_maj);
    const MaskF collides = hn::AndNot(ends, hn::Lt(entered, run));
    store_where(where_f, tau, lanes_.tau, v);
    store_where(where_f, start, lanes_.start_mm, v);
    store_where(where_f, exit, lanes_.exit_mm, v);
    store_where(where_f, run, lanes_.run_mm, v);
    store_where(where_f, mu_maj, lanes_.mu_maj, v);
    store_where(where, word, lanes_.word, v);
    store_where(where_f, hn::IfThenElseZero(collides, entered), lanes_.entered_mm, v);
    store_where(to_u(hn::And(where_f, ends)), hn::Zero(kU), lanes_.is_real, v);
    move_on(to_u(hn::And(where_f, ends)), Lanes::kDone, v, census.crossing, census.done);
    move_on(to_u(hn::And(where_f, collides)), Lanes::kLookUp, v, census.crossing, census.looking_up);
  }

  /// sample_trilinear at p, which it moves to within the voxel centres.
  F interpolate(MaskF where, const F (&p_index)[3], std::size_t v) {
    F fraction[3];
    I base[3];
    for (int a = 0; a < 3; ++a) {
      const F p =
          hn::Min(hn::Max(p_index[a], hn::Zero(kF)), hn::Set(kF, static_cast<float>(grid_.size[a] - 1)));
      base[a] = hn::Min(hn::ConvertTo(kI, p), hn::Set(kI, std::max(grid_.size[a] - 2, 0)));
      fraction[a] = hn::Sub(p, hn::ConvertTo(kF, base[a]));
    }
    const auto is_new = [&](int a) { return hn::Ne(base[a], load(lanes_.fetched[a], v)); };
    const auto fetches = hn::And(to_i(where), hn::Or(is_new(0), hn::Or(is_new(1), is_new(2))));
    for (int a = 0; a < 3; ++a) store_where(fetches, base[a], lanes_.fetched[a], v);
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(kI, fetches, bytes);
    VoxelPairs<Voxel, Lanes::kCount> pairs(lanes_.pairs, v);
    const auto* voxels = static_cast<const Voxel*>(grid_.voxels);
    const std::int64_t next_j = grid_.size[1] > 1 ? grid_.stride_j : 0,
                       next_k = grid_.size[2] > 1 ? grid_.stride_k : 0;
    const std::int32_t *i = lanes_.fetched[0].data() + v, *j = lanes_.fetched[1].data() + v,
                       *k = lanes_.fetched[2].data() + v;
    for (std::uint32_t bits = bytes[0] | bytes[1] << 8; bits; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      pairs.fetch(lane, voxels + i[lane] + j[lane] * grid_.stride_j + k[lane] * grid_.stride_k, next_j,
                  next_k);
    }
    return pairs.interpolate(kF, fraction);
  }

  /// extinction_of.
  F extinction(MaskF where, F value, std::size_t v) {
    if (medium_.rules.rule_count > 0) return extinction_by_rules(where, value, v);
    const I piece = vector_find_piece(kF, transfer_, to_i(where), value);
    F start, anchor, mu_0, slope;
    vector_load_records(kF, &transfer_.extinction->start, piece, start, anchor, mu_0, slope);
    const F mu_t = hn::Add(mu_0, hn::Mul(slope, hn::Sub(value, anchor)));
    return hn::IfThenElseZero(hn::Gt(mu_t, hn::Zero(kF)), mu_t);
  }

  /// The same, lane by lane, at lanes_.position.
  F extinction_by_rules(MaskF where, F value, std::size_t v) const {
    alignas(64) float values[kN], mu_t[kN] = {};
    hn::Store(value, kF, values);
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(kF, where, bytes);
    for (std::uint32_t bits = bytes[0] | bytes[1] << 8; bits; bits &= bits - 1) {
      const auto lane = static_cast<std::size_t>(std::countr_zero(bits));
      const Vec3f p(lanes_.position[0][v + lane], lanes_.position[1][v + lane], lanes_.position[2][v + lane]);
      mu_t[lane] = classify_mu_t(medium_.rules, p, values[lane]);
    }
    return hn::Load(kF, mu_t);
  }

  /// One tentative collision of each lane that has come to one.
  void look_up(std::size_t v, Census& census) {
    const MaskU where = in_state(v, Lanes::kLookUp);
    const MaskF where_f = to_f(where);
    const F entered = load(lanes_.entered_mm, v), mu_maj = load(lanes_.mu_maj, v);
    const F t = hn::Add(load(lanes_.start_mm, v), entered);
    const U word = load(lanes_.word, v);
    const U level = hn::And(word, hn::Set(kU, kLevelMask));
    const I size = hn::BitCast(kI, hn::Shl(hn::Set(kU, 1), level));
    const F edge = hn::Set(kF, hierarchy_.cell_voxels);
    F p[3];
    for (int a = 0; a < 3; ++a) {
      const I first = load(lanes_.cell[a], v);
      const F lower = hn::Mul(hn::ConvertTo(kF, first), edge);
      const F upper = hn::Mul(hn::ConvertTo(kF, hn::Add(first, size)), edge);
      p[a] = hn::Add(load(lanes_.origin[a], v), hn::Mul(load(lanes_.direction[a], v), t));
      p[a] = hn::Min(hn::Max(p[a], lower), upper);
      store_where(where_f, p[a], lanes_.position[a], v);
    }
    const F value = interpolate(where_f, p, v);
    const F mu_t = extinction(where_f, value, v);
    store_where(where_f, value, lanes_.value, v);
    const U one = hn::Set(kU, 1);
    store(hn::Add(load(lanes_.steps, v), hn::IfThenElseZero(where, one)), lanes_.steps, v);
    const F mu_cell = majorant(word);
    const MaskU violated = to_u(hn::And(where_f, hn::Gt(mu_t, mu_cell)));
    store(hn::Add(load(lanes_.violations, v), hn::IfThenElseZero(violated, one)), lanes_.violations, v);

    const F threshold = load(lanes_.threshold, v);
    const MaskU shadow = hn::Ne(load(lanes_.is_shadow, v), hn::Zero(kU));
    F met = mu_t;
    if (medium_.shadow_extinction != 1)
      met = hn::IfThenElse(to_f(shadow), hn::Mul(mu_t, hn::Set(kF, medium_.shadow_extinction)), mu_t);
    F transmittance =
        hn::Mul(load(lanes_.transmittance, v), hn::Sub(hn::Set(kF, 1.0f), hn::Div(met, mu_maj)));
    const MaskU low = hn::And(where, to_u(hn::Lt(transmittance, threshold)));
    const MaskU gambles = hn::And(low, shadow), real = hn::AndNot(shadow, low);
    MaskU done = real;
    if (!hn::AllFalse(kU, gambles)) {
      const F u = draw(gambles, v);
      const MaskU dies = hn::And(gambles, to_u(hn::Ge(hn::Mul(u, threshold), transmittance)));
      transmittance =
          hn::IfThenElse(to_f(gambles), hn::IfThenElseZero(to_f(hn::Not(dies)), threshold), transmittance);
      done = hn::Or(done, dies);
    }
    store_where(where_f, transmittance, lanes_.transmittance, v);

    const MaskU goes_on = hn::AndNot(done, where);
    store_where(done, hn::IfThenElseZero(real, hn::Set(kU, ~0u)), lanes_.is_real, v);
    move_on(done, Lanes::kDone, v, census.looking_up, census.done);
    if (hn::AllFalse(kU, goes_on)) return;
    const F tau = optical_depth(draw(goes_on, v));
    const auto in_matter = hn::Gt(mu_t, hn::Mul(mu_cell, hn::Set(kF, kMatterShare)));
    const F rate = hn::IfThenElse(in_matter, load(lanes_.rate_in_matter, v), load(lanes_.rate_elsewhere, v));
    const F next_maj = hn::Mul(mu_cell, rate);
    store_where(to_f(goes_on), rate, lanes_.rate, v);
    store_where(to_f(goes_on), next_maj, lanes_.mu_maj, v);
    const F next = hn::Add(entered, hn::Div(tau, next_maj));
    const MaskF stays = hn::Lt(next, load(lanes_.run_mm, v));
    store_where(to_f(goes_on), tau, lanes_.tau, v);
    store_where(hn::And(to_f(goes_on), stays), next, lanes_.entered_mm, v);
    move_on(hn::AndNot(to_u(stays), goes_on), Lanes::kCross, v, census.looking_up, census.crossing);
  }

  const HierarchyView& hierarchy_;
  const GridView& grid_;
  const TransferView& transfer_;
  const Medium& medium_;
  Lanes& lanes_;
};

/// The tracker for the medium's voxel type.
inline VectorTracker select_tracker(VoxelType type) {
  return with_voxel_type(type, [](auto value) -> VectorTracker {
    return [](const Medium& medium, Lanes& lanes) { LaneTracker<decltype(value)>(medium, lanes).run(); };
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
