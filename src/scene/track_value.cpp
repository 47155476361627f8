#include "scene/track_value.h"

#include <algorithm>

namespace voxlume {
namespace {

using Points = std::vector<TransferPoint>;

/// The window of one number of the values.
template <class T, class Pick>
NumberWindow pick_number(const KeyWindow<T>& window, Pick pick) {
  const auto entry = [&](const auto& key) {
    return NumberWindow::Key{key.time_s, static_cast<double>(pick(key.value))};
  };
  NumberWindow out{{}, entry(window.begin), entry(window.end), {}};
  if (window.before) out.before = entry(*window.before);
  if (window.after) out.after = entry(*window.after);
  return out;
}

template <std::size_t N>
std::array<double, N> each_number(const KeyWindow<std::array<double, N>>& window, double time_s,
                                  Interpolation interpolation) {
  std::array<double, N> out;
  for (std::size_t i = 0; i < N; ++i) {
    const auto pick = [i](const std::array<double, N>& value) { return value[i]; };
    out[i] = interpolate(pick_number(window, pick), time_s, interpolation);
  }
  return out;
}

constexpr std::optional<double> TransferPoint::*kNumbers[] = {
    &TransferPoint::opacity,      &TransferPoint::mu_t_per_mm, &TransferPoint::roughness,
    &TransferPoint::metallic,     &TransferPoint::specular,    &TransferPoint::anisotropy,
    &TransferPoint::surface_share};
constexpr std::optional<Color> TransferPoint::*kColors[] = {&TransferPoint::color, &TransferPoint::emission,
                                                            &TransferPoint::extinction_color};

/// Whether two functions have points that correspond.
bool same_form(const Points& a, const Points& b) {
  const auto alike = [](const TransferPoint& p, const TransferPoint& q) {
    const auto both = [&](auto member) { return (p.*member).has_value() == (q.*member).has_value(); };
    return p.material == q.material && std::all_of(std::begin(kNumbers), std::end(kNumbers), both) &&
           std::all_of(std::begin(kColors), std::end(kColors), both);
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), alike);
}

/// Sets every number of out[i] from those of the window's points i.
struct PointBlend {
  const KeyWindow<Points>& window;
  std::size_t i;
  double time_s;
  Interpolation interpolation;

  template <class Pick>
  double number(Pick pick) const {
    const auto of_list = [&](const Points& points) { return pick(points[i]); };
    return interpolate(pick_number(window, of_list), time_s, interpolation);
  }
  void set(std::optional<double> TransferPoint::*member, TransferPoint& out) const {
    if (out.*member) out.*member = number([member](const TransferPoint& p) { return *(p.*member); });
  }
  void set(std::optional<Color> TransferPoint::*member, TransferPoint& out) const {
    for (std::size_t c = 0; c < 3 && out.*member; ++c) {
      const auto channel = [member, c](const TransferPoint& p) { return (p.*member)->linear[c]; };
      (out.*member)->linear[c] = static_cast<float>(number(channel));
    }
  }
};

}  // namespace

Color interpolate_value(const KeyWindow<Color>& window, double time_s, Interpolation interpolation, bool) {
  Color out;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto channel = [c](const Color& color) { return color.linear[c]; };
    out.linear[c] = static_cast<float>(interpolate(pick_number(window, channel), time_s, interpolation));
  }
  return out;
}

Double3 interpolate_value(const KeyWindow<Double3>& window, double time_s, Interpolation interpolation,
                          bool is_direction) {
  if (is_direction && interpolation != Interpolation::kStep)
    return interpolate_direction(window, time_s, interpolation);
  return each_number(window, time_s, interpolation);
}

std::array<double, 2> interpolate_value(const KeyWindow<std::array<double, 2>>& window, double time_s,
                                        Interpolation interpolation, bool) {
  return each_number(window, time_s, interpolation);
}

Points interpolate_value(const KeyWindow<Points>& window, double time_s, Interpolation interpolation, bool) {
  Points out = window.begin.value;
  if (!same_form(out, window.end.value)) return out;
  KeyWindow<Points> alike{{}, window.begin, window.end, {}};
  if (window.before && same_form(window.before->value, out)) alike.before = window.before;
  if (window.after && same_form(out, window.after->value)) alike.after = window.after;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const PointBlend blend{alike, i, time_s, interpolation};
    out[i].value = blend.number([](const TransferPoint& p) { return p.value; });
    for (const auto member : kNumbers) blend.set(member, out[i]);
    for (const auto member : kColors) blend.set(member, out[i]);
  }
  return out;
}

}  // namespace voxlume
