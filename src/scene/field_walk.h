#pragma once
#include <charconv>
#include <string>
#include <string_view>
#include <utility>

#include "scene/field_types.h"
#include "voxlume/error.h"

namespace voxlume {

// Finding a field by its address, a JSON pointer such as "/lights/0/intensity". Errors are thrown at `where`.

/// Throws Error: no field of this name, with the nearest one of `known` (none: a plain value has no fields).
[[noreturn]] void unknown_field(std::string_view key, const std::vector<std::string_view>& known,
                                const std::string& where);
/// Throws Error unless `address` starts with '/'.
void check_address(std::string_view address, const std::string& where);
/// Takes "/key" off the front of `address` and returns the key.
std::string_view take_key(std::string_view& address);
/// The index that `key` stands for. Throws Error unless it is below `count`.
std::size_t element_index(std::string_view key, std::size_t count, const std::string& where);

/// Walks down `address` from a value to a field; absent structs on the way are created.
struct FieldWalk {
  const std::string& where;

  /// Calls visit(info, field) with the field's own type; an empty address is `value` itself.
  template <class T, class F>
  void visit(std::string_view address, const FieldInfo& info, T& value, F& visitor) const {
    if (address.empty()) {
      visitor(info, value);
      return;
    }
    if constexpr (OptionalField<T>) {
      if (!value) value.emplace();
      visit(address, info, *value, visitor);
    } else if constexpr (StructField<T>) {
      const std::string_view key = take_key(address);
      bool found = false;
      visit_fields(
          [&](const FieldInfo& inner, auto member) {
            if (key != inner.key) return;
            found = true;
            visit(address, inner, value.*member, visitor);
          },
          Struct<T>{});
      if (!found) unknown_field(key, field_keys<T>(), where);
    } else if constexpr (ListField<T> || TupleField<T>) {
      const std::size_t index = element_index(take_key(address), value.size(), where);
      visit(address, info, value[index], visitor);
    } else {
      unknown_field(take_key(address), {}, where);
    }
  }
};

/// The same by types alone, for an address in any scene: calls visitor(info, Type<T>{}), T the field's own
/// type without `optional`. Elements of lists may have any index below the list's largest size.
template <class T>
struct Type {};
struct FieldTypeWalk {
  const std::string& where;

  template <class T, class F>
  void visit(std::string_view address, const FieldInfo& info, Type<T> type, F& visitor) const {
    if constexpr (OptionalField<T>) {
      visit(address, info, Type<typename T::value_type>{}, visitor);
    } else if (address.empty()) {
      visitor(info, type);
    } else if constexpr (StructField<T>) {
      const std::string_view key = take_key(address);
      bool found = false;
      visit_fields(
          [&]<class M>(const FieldInfo& inner, M T::*) {
            if (key != inner.key) return;
            found = true;
            visit(address, inner, Type<M>{}, visitor);
          },
          Struct<T>{});
      if (!found) unknown_field(key, field_keys<T>(), where);
    } else if constexpr (ListField<T> || TupleField<T>) {
      std::size_t count = info.max_count;
      if constexpr (TupleField<T>) count = std::tuple_size_v<T>;
      element_index(take_key(address), count, where);
      visit(address, info, Type<typename T::value_type>{}, visitor);
    } else {
      unknown_field(take_key(address), {}, where);
    }
  }
};

}  // namespace voxlume
