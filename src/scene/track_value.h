#pragma once
#include <string>

#include "scene/field_reader.h"
#include "scene/field_writer.h"
#include "scene/interpolate.h"

namespace voxlume {

/// What a track can give to a field.
template <class T>
concept TrackValue = std::is_same_v<T, double> || std::is_same_v<T, bool> || std::is_same_v<T, Color> ||
    std::is_same_v<T, std::string> || std::is_same_v<T, std::vector<TransferPoint>> || EnumField<T> ||
    std::is_same_v<T, std::array<double, 2>> || std::is_same_v<T, Double3>;

/// A key's value as the field's type. Throws Error, with the address of the value in the key at `where`, for
/// another type or a number out of the field's range.
template <TrackValue T>
T key_value(const AnimationKey& key, const FieldInfo& info, const std::string& where) {
  const std::string address = child_address(where, "1");
  T value{};
  FieldReader::read(nlohmann::json(FieldWriter{}.json(key.value)), info, address, value);
  check_field(value, info, address);
  return value;
}

// interpolate_value(window, time_s, interpolation, is_direction): what a field is at `time_s`, between the
// window's begin and end.

inline double interpolate_value(const NumberWindow& window, double time_s, Interpolation interpolation,
                                bool /*is_direction*/) {
  return interpolate(window, time_s, interpolation);
}
/// Each channel by itself, in linear light.
Color interpolate_value(const KeyWindow<Color>& window, double time_s, Interpolation interpolation,
                        bool is_direction);
Double3 interpolate_value(const KeyWindow<Double3>& window, double time_s, Interpolation interpolation,
                          bool is_direction);
std::array<double, 2> interpolate_value(const KeyWindow<std::array<double, 2>>& window, double time_s,
                                        Interpolation interpolation, bool is_direction);
/// Point by point, where begin and end have as many and give the same coefficients; else begin's.
std::vector<TransferPoint> interpolate_value(const KeyWindow<std::vector<TransferPoint>>& window,
                                             double time_s, Interpolation interpolation, bool is_direction);
/// Words and switches step.
template <class T>
T interpolate_value(const KeyWindow<T>& window, double, Interpolation, bool) {
  return window.begin.value;
}

}  // namespace voxlume
