#include <charconv>
#include <nlohmann/json.hpp>

#include "scene/field_reader.h"
#include "scene/field_walk.h"
#include "scene/scene_file.h"

namespace voxlume {
namespace {

using nlohmann::json;

/// A number as strictly as JSON has it, else the text itself, which the reader then refuses with a message.
json number_or_text(std::string_view text) {
  const char* const end = text.data() + text.size();
  const auto whole = [&](auto number) -> std::optional<json> {
    const auto [stop, failed] = std::from_chars(text.data(), end, number);
    if (failed == std::errc{} && stop == end && !text.empty()) return json(number);
    return std::nullopt;
  };
  if (const auto number = whole(std::uint64_t{})) return *number;
  if (const auto number = whole(std::int64_t{})) return *number;
  if (const auto number = whole(double{})) return *number;
  return std::string(text);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t start = 0;;) {
    const std::size_t end = text.find(separator, start);
    parts.push_back(text.substr(start, end - start));
    if (end == std::string_view::npos) return parts;
    start = end + 1;
  }
}

json number_list(std::string_view text) {
  json out = json::array();
  for (const std::string_view part : split(text, ',')) out.push_back(number_or_text(part));
  return out;
}

json json_text(std::string_view text, const std::string& where) {
  const json value = json::parse(text.begin(), text.end(), nullptr, false);
  if (value.is_discarded())
    throw Error(ErrorCode::kBadParameter, where, "found " + quote_text(text) + ", expected JSON");
  return value;
}

/// The JSON that `text` stands for where a T is expected.
template <class T>
json json_from_text(std::string_view text, const std::string& where) {
  if constexpr (OptionalField<T>) {
    return json_from_text<typename T::value_type>(text, where);
  } else if constexpr (std::is_same_v<T, bool>) {
    return text == "true" ? json(true) : text == "false" ? json(false) : json(std::string(text));
  } else if constexpr (std::is_arithmetic_v<T>) {
    return number_or_text(text);
  } else if constexpr (TupleField<T>) {
    return number_list(text);
  } else if constexpr (std::is_same_v<T, Color>) {
    if (text.starts_with('{') || text.starts_with('[')) return json_text(text, where);
    return text.starts_with('#') ? json(std::string(text)) : number_list(text);
  } else if constexpr (std::is_same_v<T, std::vector<std::string>>) {
    json out = json::array();
    if (text.empty()) return out;
    for (const std::string_view part : split(text, ',')) out.push_back(std::string(part));
    return out;
  } else if constexpr (StructField<T> || ListField<T> || std::is_same_v<T, AnimationKey>) {
    return json_text(text, where);
  } else {
    return std::string(text);
  }
}

}  // namespace

void unknown_field(std::string_view key, const std::vector<std::string_view>& known,
                   const std::string& where) {
  const std::string nearest = nearest_word(key, known);
  throw Error(ErrorCode::kBadParameter, where,
              "unknown field " + quote_text(key) + "; " +
                  (known.empty()     ? "a plain value has no fields"
                   : nearest.empty() ? "expected one of " + join_words(known)
                                     : "did you mean " + quote_text(nearest) + "?"));
}

void check_address(std::string_view address, const std::string& where) {
  if (address.starts_with('/')) return;
  throw Error(ErrorCode::kBadParameter, where,
              "found field " + quote_text(address) + ", expected an address such as \"/image/spp\"");
}

std::string_view take_key(std::string_view& address) {
  address.remove_prefix(1);
  const std::string_view key = address.substr(0, address.find('/'));
  address.remove_prefix(key.size());
  return key;
}

std::size_t element_index(std::string_view key, std::size_t count, const std::string& where) {
  std::size_t index = 0;
  const auto [stop, failed] = std::from_chars(key.data(), key.data() + key.size(), index);
  if (failed != std::errc{} || stop != key.data() + key.size() || index >= count) {
    throw Error(ErrorCode::kBadParameter, where,
                "found element " + quote_text(key) + ", expected one of the list's " + std::to_string(count));
  }
  return index;
}

std::string describe_scene_field(std::string_view address) {
  std::string text;
  const auto describe = [&](const FieldInfo& info, auto) {
    text = info.doc;
    std::string range = range_text(info.range);
    if (*info.unit) range += (range.empty() ? "" : " ") + std::string(info.unit);
    if (!range.empty()) text += " (" + range + ")";
  };
  const std::string where(address);
  check_address(address, where);
  FieldTypeWalk{where}.visit(address, FieldInfo{.key = "", .doc = ""}, Type<SceneDescription>{}, describe);
  return text;
}

void set_scene_field(SceneDescription& scene, std::string_view address, std::string_view text,
                     const std::string& where) {
  check_address(address, where);
  const auto set = [&]<class T>(const FieldInfo& info, T& field) {
    FieldReader::read(json_from_text<T>(text, where), info, where, field);
    check_field(field, info, where);
  };
  FieldWalk{where}.visit(address, FieldInfo{.key = "", .doc = ""}, scene, set);
}

}  // namespace voxlume
