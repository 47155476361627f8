#pragma once
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "scene/field_check.h"
#include "voxlume/error.h"

namespace voxlume {

/// One line describing a JSON value: `"text"`, `3.5`, `an object`, `a list of 4`.
std::string describe_json(const nlohmann::json& value);
/// Reads "#rrggbb", [r,g,b] (both sRGB-encoded) or {"linear":[r,g,b]}. Throws Error at `where`.
Color read_color(const nlohmann::json& value, const std::string& where);

/// Turns JSON into a description by the field table. Checks types, keys and list lengths; number ranges and
/// rules between fields are validate_scene's. `where` names the value in every Error: "scene.json:
/// /image/spp".
class FieldReader {
 public:
  using json = nlohmann::json;

  template <StructField T>
  static void read(const json& value, const FieldInfo&, const std::string& where, T& out) {
    if (!value.is_object()) fail(value, where, "an object");
    check_keys(value, where, field_keys<T>());
    visit_fields(
        [&](const FieldInfo& info, auto member) {
          const auto found = value.find(info.key);
          if (found != value.end()) {
            read(*found, info, child_address(where, info.key), out.*member);
          } else if (info.required) {
            throw Error(ErrorCode::kBadParameter, where, "missing key " + quote_text(info.key));
          }
        },
        Struct<T>{});
  }

  template <OptionalField T>
  static void read(const json& value, const FieldInfo& info, const std::string& where, T& out) {
    typename T::value_type inner{};
    read(value, info, where, inner);
    out = std::move(inner);
  }

  template <ListField T>
  static void read(const json& value, const FieldInfo& info, const std::string& where, T& out) {
    if (!value.is_array()) fail(value, where, "a list");
    if (value.size() > info.max_count)
      fail(value, where, "at most " + std::to_string(info.max_count) + " elements");
    out.assign(value.size(), {});
    for (std::size_t i = 0; i < value.size(); ++i) read_element(value[i], info, where, i, out[i]);
  }

  template <TupleField T>
  static void read(const json& value, const FieldInfo& info, const std::string& where, T& out) {
    if (!value.is_array() || value.size() != out.size()) {
      fail(value, where, "a list of " + std::to_string(out.size()) + " numbers");
    }
    for (std::size_t i = 0; i < out.size(); ++i) read_element(value[i], info, where, i, out[i]);
  }

  template <EnumField T>
  static void read(const json& value, const FieldInfo&, const std::string& where, T& out) {
    const std::vector<std::string_view> words(EnumWords<T>::kWords.begin(), EnumWords<T>::kWords.end());
    const std::string expected = "one of " + join_words(words);
    if (!value.is_string()) fail(value, where, expected);
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (value.get_ref<const std::string&>() == words[i]) {
        out = static_cast<T>(i);
        return;
      }
    }
    fail(value, where, expected);
  }

  template <IntegerField T>
  static void read(const json& value, const FieldInfo& info, const std::string& where, T& out) {
    const std::string range = range_text(info.range);
    const std::string expected = "a whole number" + (range.empty() ? "" : " " + range);
    using Limits = std::numeric_limits<T>;
    if (value.is_number_unsigned()) {
      const auto x = value.get<std::uint64_t>();
      if (x > static_cast<std::uint64_t>(Limits::max())) fail(value, where, expected);
      out = static_cast<T>(x);
    } else if (value.is_number_integer()) {
      const auto x = value.get<std::int64_t>();
      if (x < 0 && (!Limits::is_signed || x < static_cast<std::int64_t>(Limits::min())))
        fail(value, where, expected);
      out = static_cast<T>(x);
    } else if (value.is_number_float()) {
      // 16.0 is a whole number to JSON Schema; beyond 2^31 a fraction could have been lost.
      const auto x = value.get<double>();
      if (!(std::abs(x) < 2147483648.0) || x != std::floor(x) || (x < 0 && !Limits::is_signed)) {
        fail(value, where, expected);
      }
      out = static_cast<T>(x);
    } else {
      fail(value, where, expected);
    }
  }

  static void read(const json& value, const FieldInfo& info, const std::string& where, double& out);
  static void read(const json& value, const FieldInfo& info, const std::string& where, bool& out);
  static void read(const json& value, const FieldInfo& info, const std::string& where, std::string& out);
  static void read(const json& value, const FieldInfo&, const std::string& where, Color& out) {
    out = read_color(value, where);
  }
  /// [time, value]; the value by its own shape, whatever the field.
  static void read(const json& value, const FieldInfo&, const std::string& where, AnimationKey& out);

 private:
  /// Element `i` of a list or tuple at `where`.
  template <class T>
  static void read_element(const json& value, const FieldInfo& info, const std::string& where, std::size_t i,
                           T& out) {
    if constexpr (std::is_same_v<T, double>) {
      if (info.open_ended && value.is_null()) {
        out = i == 0 ? info.range.lower : info.range.upper;
        return;
      }
    }
    read(value, info, child_address(where, std::to_string(i)), out);
  }
  /// Throws Error: the first key of `object` that is not in `known`, with the nearest one that is.
  static void check_keys(const json& object, const std::string& where,
                         const std::vector<std::string_view>& known);
  [[noreturn]] static void fail(const json& found, const std::string& where, const std::string& expected);
};

}  // namespace voxlume
