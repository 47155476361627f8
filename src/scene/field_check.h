#pragma once
#include <string>

#include "scene/field_types.h"

namespace voxlume {

// check_field(value, info, where): the number ranges and vocabularies of the field table, for a value and
// everything inside it. Throws Error at `where`.

void check_field(double value, const FieldInfo& info, const std::string& where);
void check_field(const Color& value, const FieldInfo& info, const std::string& where);
void check_field(const std::string& value, const FieldInfo& info, const std::string& where);
/// The time alone; what values are good for is the field's to say (check_animation).
void check_field(const AnimationKey& value, const FieldInfo& info, const std::string& where);
void check_integer(std::int64_t value, const FieldInfo& info, const std::string& where);
[[noreturn]] void fail_count(std::size_t count, const FieldInfo& info, const std::string& where);
/// The address of a key or index inside `where`: "scene.json: /" and "image" make "scene.json: /image".
std::string child_address(const std::string& where, std::string_view key);

inline void check_field(bool, const FieldInfo&, const std::string&) {}
template <EnumField T>
void check_field(T, const FieldInfo&, const std::string&) {}
template <IntegerField T>
void check_field(T value, const FieldInfo& info, const std::string& where) {
  // The only bound of a 64-bit unsigned field is its type.
  if constexpr (!std::is_same_v<T, std::uint64_t>)
    check_integer(static_cast<std::int64_t>(value), info, where);
}
template <TupleField T>
void check_field(const T& value, const FieldInfo& info, const std::string& where);
template <ListField T>
void check_field(const T& value, const FieldInfo& info, const std::string& where);
template <StructField T>
void check_field(const T& value, const FieldInfo& info, const std::string& where);
template <OptionalField T>
void check_field(const T& value, const FieldInfo& info, const std::string& where) {
  if (value) check_field(*value, info, where);
}

template <TupleField T>
void check_field(const T& value, const FieldInfo& info, const std::string& where) {
  for (std::size_t i = 0; i < value.size(); ++i)
    check_field(value[i], info, child_address(where, std::to_string(i)));
}
template <ListField T>
void check_field(const T& value, const FieldInfo& info, const std::string& where) {
  if (value.size() > info.max_count) fail_count(value.size(), info, where);
  for (std::size_t i = 0; i < value.size(); ++i)
    check_field(value[i], info, child_address(where, std::to_string(i)));
}
template <StructField T>
void check_field(const T& value, const FieldInfo&, const std::string& where) {
  visit_fields([&](const FieldInfo& info,
                   auto member) { check_field(value.*member, info, child_address(where, info.key)); },
               Struct<T>{});
}

}  // namespace voxlume
