#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "scene/field_types.h"

namespace voxlume {

using OrderedJson = nlohmann::ordered_json;

/// {"linear":[r,g,b]}, each channel with the fewest digits that read back as the same float.
OrderedJson color_json(const Color& color);
/// JSON text for people: objects and lists stay on one line while they fit 100 columns.
std::string print_json(const OrderedJson& value);

/// Turns descriptions into JSON by the field table.
struct FieldWriter {
  bool all_fields = false;

  template <StructField T>
  OrderedJson json(const T& value) const {
    const T defaults{};
    OrderedJson out = OrderedJson::object();
    visit_fields(
        [&](const FieldInfo& info, auto member) {
          if constexpr (OptionalField<std::remove_cvref_t<decltype(value.*member)>>) {
            if (value.*member) out[info.key] = json(*(value.*member));
          } else if (info.required || all_fields || !(value.*member == defaults.*member)) {
            out[info.key] = json(value.*member, info);
          }
        },
        Struct<T>{});
    return out;
  }
  /// A field of that table entry.
  template <class T>
  OrderedJson json(const T& value, const FieldInfo& info) const {
    OrderedJson out = json(value);
    if (!info.open_ended) return out;
    for (OrderedJson& end : out)
      if (end <= info.range.lower || end >= info.range.upper) end = nullptr;
    return out;
  }
  template <class T>
  requires(ListField<T> || TupleField<T>) OrderedJson json(const T& value)
  const {
    OrderedJson out = OrderedJson::array();
    for (const auto& element : value) out.push_back(json(element));
    return out;
  }
  template <EnumField T>
  OrderedJson json(T value) const {
    return enum_word(value);
  }
  template <class T>
  requires(std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) OrderedJson json(const T& value)
  const { return value; }
  OrderedJson json(const Color& value) const { return color_json(value); }
  OrderedJson json(const FieldValue& value) const {
    const FieldInfo pair{.key = "", .doc = "", .range = kAnyFace, .open_ended = true};
    const bool list = std::holds_alternative<std::vector<double>>(value);
    return std::visit([&](const auto& v) { return list ? json(v, pair) : json(v); }, value);
  }
  OrderedJson json(const AnimationKey& key) const {
    return OrderedJson::array({json(key.time_s), json(key.value)});
  }
};

}  // namespace voxlume
