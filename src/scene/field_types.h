#pragma once
#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "scene/field_table.h"

namespace voxlume {

// What kind of thing a member of a description is; decides how it is read, written and documented.

template <class T>
struct is_optional : std::false_type {};
template <class T>
struct is_optional<std::optional<T>> : std::true_type {};
template <class T>
struct is_vector : std::false_type {};
template <class T>
struct is_vector<std::vector<T>> : std::true_type {};
template <class T>
struct is_array : std::false_type {};
template <class T, std::size_t N>
struct is_array<std::array<T, N>> : std::true_type {};

template <class T>
concept OptionalField = is_optional<T>::value;
template <class T>
concept ListField = is_vector<T>::value;
template <class T>
concept TupleField = is_array<T>::value;
template <class T>
concept IntegerField = std::is_integral_v<T> && !std::is_same_v<T, bool>;
template <class T>
concept EnumField = std::is_enum_v<T>;
template <class T>
concept StructField = requires {
  struct_info(Struct<T>{});
};

/// The keys of a struct, in file order.
template <StructField T>
std::vector<std::string_view> field_keys() {
  std::vector<std::string_view> keys;
  visit_fields([&](const FieldInfo& info, auto) { keys.push_back(info.key); }, Struct<T>{});
  return keys;
}

}  // namespace voxlume
