#pragma once
#include <optional>
#include <vector>

#include "voxlume/scene.h"

namespace voxlume {

// Values between the keys of a track, in double precision.

/// Four keys in a row: from `begin` to `end` is where the time is; `before` and `after`, where they are,
/// shape a smooth course.
template <class T>
struct KeyWindow {
  struct Key {
    double time_s;
    T value;
  };
  std::optional<Key> before;
  Key begin, end;  ///< begin.time_s < end.time_s
  std::optional<Key> after;
};

using NumberWindow = KeyWindow<double>;

/// The value at `time_s` in [begin, end). Smooth: a cubic whose slopes are the weighted harmonic means of the
/// neighbouring differences (Fritsch and Butland 1984), so that it never leaves the range of begin and end; 0
/// where there is no neighbour. Step: begin's.
double interpolate(const NumberWindow& window, double time_s, Interpolation interpolation);

/// Turns from begin's direction to end's by the shortest way, evenly in angle or, if smooth, with the angle's
/// own smooth course. Opposite directions turn over +z, or +y where they are along z. Unit vectors.
Double3 interpolate_direction(const KeyWindow<Double3>& window, double time_s, Interpolation interpolation);

}  // namespace voxlume
