#pragma once
#include <array>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "voxlume/scene.h"

namespace voxlume {

/// The magnitude no number of a scene exceeds unless its field says otherwise; keeps single precision finite.
constexpr double kLargestNumber = 1e12;

/// The numbers a field accepts. For arrays and colors it holds for every element.
struct NumberRange {
  double lower = -kLargestNumber, upper = kLargestNumber;
  bool open_lower = false, open_upper = false;

  /// NaN is never inside.
  constexpr bool contains(double x) const {
    return (open_lower ? x > lower : x >= lower) && (open_upper ? x < upper : x <= upper);
  }
  constexpr bool bounded_below() const { return lower > -kLargestNumber; }
  constexpr bool bounded_above() const { return upper < kLargestNumber; }
};

constexpr NumberRange at_least(double x) { return {.lower = x}; }
constexpr NumberRange above(double x) { return {.lower = x, .open_lower = true}; }
constexpr NumberRange between(double a, double b) { return {.lower = a, .upper = b}; }
constexpr NumberRange above_to(double a, double b) { return {.lower = a, .upper = b, .open_lower = true}; }
/// Where a clip box has no face, as ClipDescription starts [mm]; null in scene files.
constexpr double kOpenFace_mm = 1e30;
/// Of the ends of a clip box.
constexpr NumberRange kAnyFace = between(-kOpenFace_mm, kOpenFace_mm);
constexpr NumberRange inside(double a, double b) {
  return {.lower = a, .upper = b, .open_lower = true, .open_upper = true};
}

/// ">= 0", "in (0, 170]", or "" where nothing but kLargestNumber bounds it.
std::string range_text(const NumberRange& range);

/// The words a text field accepts; `planned` ones are known, and refused as not built yet.
struct WordChoices {
  std::vector<std::string_view> available;
  std::vector<std::string_view> planned;
};

/// What is known of a field of the scene besides its C++ type. The reader, the writer, the checks, the JSON
/// schema and the reference are all made from it.
struct FieldInfo {
  const char* key;        ///< in the scene file
  const char* doc;        ///< one sentence
  const char* unit = "";  ///< "mm", "1/mm", "degrees", ... or empty
  NumberRange range{};
  const WordChoices* words = nullptr;  ///< text fields (or lists of text) with a fixed vocabulary
  const char* absent = "";             ///< optional fields: what holds where the key is absent
  std::size_t max_count = 4096;        ///< lists: most elements
  bool required = false;               ///< must be in the file, and is always written
  bool is_path = false;                ///< text naming a file: relative ones belong to the scene's folder
  bool is_direction = false;           ///< a vector whose length means nothing
  bool open_ended = false;  ///< a pair of ends: one at its bound of the range is not there, null in files
};

/// Names the struct whose table is meant.
template <class T>
struct Struct {};

/// Title and one paragraph of a struct, for the schema and the reference.
struct StructInfo {
  const char* name;
  const char* doc;
};

/// Names of enumerators, in the order of the enumeration.
template <class E>
struct EnumWords;

template <>
struct EnumWords<Shading> {
  static constexpr std::array<std::string_view, 5> kWords{"coexistence", "er", "phase", "brdf",
                                                          "blinn-phong"};
};
template <>
struct EnumWords<LobeModel> {
  static constexpr std::array<std::string_view, 3> kWords{"auto", "reciprocal", "particles"};
};
template <>
struct EnumWords<ProxyKind> {
  static constexpr std::array<std::string_view, 4> kWords{"file", "gradient", "smoothed", "distance"};
};
template <>
struct EnumWords<Lookup> {
  static constexpr std::array<std::string_view, 2> kWords{"linear", "nearest"};
};
template <>
struct EnumWords<Outline> {
  static constexpr std::array<std::string_view, 2> kWords{"voxels", "smooth"};
};
template <>
struct EnumWords<RuleKind> {
  static constexpr std::array<std::string_view, 5> kWords{"cctf", "cpctf", "cdptf", "mpctf", "mdptf"};
};
template <>
struct EnumWords<ColumnForm> {
  static constexpr std::array<std::string_view, 3> kWords{"curve", "steps", "points"};
};
template <>
struct EnumWords<Merge> {
  static constexpr std::array<std::string_view, 3> kWords{"product", "priority", "maximum"};
};
template <>
struct EnumWords<SurfaceShareForm> {
  static constexpr std::array<std::string_view, 4> kWords{"hybrid", "exponential", "modulation", "threshold"};
};
template <>
struct EnumWords<LightKind> {
  static constexpr std::array<std::string_view, 3> kWords{"directional", "point", "rect"};
};
template <>
struct EnumWords<Attachment> {
  static constexpr std::array<std::string_view, 2> kWords{"world", "camera"};
};
template <>
struct EnumWords<BackgroundKind> {
  static constexpr std::array<std::string_view, 3> kWords{"color", "environment", "transparent"};
};
template <>
struct EnumWords<Projection> {
  static constexpr std::array<std::string_view, 2> kWords{"perspective", "orthographic"};
};
template <>
struct EnumWords<PixelFilter> {
  static constexpr std::array<std::string_view, 2> kWords{"gaussian", "box"};
};
template <>
struct EnumWords<Sampler> {
  static constexpr std::array<std::string_view, 2> kWords{"sobol", "random"};
};
template <>
struct EnumWords<TransmittanceEstimator> {
  static constexpr std::array<std::string_view, 3> kWords{"ratio", "residual", "marching"};
};
template <>
struct EnumWords<FreeFlightSampling> {
  static constexpr std::array<std::string_view, 2> kWords{"delta", "decomposition"};
};
template <>
struct EnumWords<Extinction> {
  static constexpr std::array<std::string_view, 2> kWords{"single", "rgb"};
};
template <>
struct EnumWords<Integrator> {
  static constexpr std::array<std::string_view, 6> kWords{"path", "exposure-render", "rmss", "vpl-dvr",
                                                          "ar2t", "ray-march"};
};
template <>
struct EnumWords<VisibilityLights> {
  static constexpr std::array<std::string_view, 3> kWords{"off", "first", "all"};
};
template <>
struct EnumWords<ImportanceLookup> {
  static constexpr std::array<std::string_view, 3> kWords{"interpolated", "per-voxel", "smoothed"};
};
template <>
struct EnumWords<ImportanceSums> {
  static constexpr std::array<std::string_view, 2> kWords{"integral", "discrete"};
};
template <>
struct EnumWords<ToneCurve> {
  static constexpr std::array<std::string_view, 2> kWords{"filmic", "srgb"};
};
template <>
struct EnumWords<Interpolation> {
  static constexpr std::array<std::string_view, 3> kWords{"linear", "smooth", "step"};
};

/// The word of an enumerator, as scenes and statistics spell it.
template <class E>
constexpr std::string_view enum_word(E e) {
  return EnumWords<E>::kWords[static_cast<std::size_t>(e)];
}

/// The entry of `known` nearest to `word` by edit distance, or "" where none is near enough to be a slip of
/// the finger (more than a third of its letters, at least two, differ).
std::string nearest_word(std::string_view word, const std::vector<std::string_view>& known);

/// `text` between double quotes on one line: control characters and invalid bytes escaped, long text cut.
std::string quote_text(std::string_view text);

/// "a, b, c".
std::string join_words(const std::vector<std::string_view>& words);

}  // namespace voxlume
