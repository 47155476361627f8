#include "scene/field_reader.h"

#include <fmt/format.h>

#include "tonemap/srgb.h"

namespace voxlume {

using nlohmann::json;

std::string describe_json(const json& value) {
  switch (value.type()) {
    case json::value_t::string:
      return quote_text(value.get_ref<const std::string&>());
    case json::value_t::object:
      return "an object";
    case json::value_t::array:
      return fmt::format("a list of {}", value.size());
    // Not dump(): it writes null for what is not finite.
    case json::value_t::number_float:
      return fmt::format("{}", value.get<double>());
    case json::value_t::number_integer:
    case json::value_t::number_unsigned:
    case json::value_t::boolean:
      return value.dump();
    default:
      return "null";
  }
}

namespace {

[[noreturn]] void fail_color(const json& value, const std::string& where) {
  throw Error(ErrorCode::kBadParameter, where,
              "found " + describe_json(value) +
                  R"(, expected a color: "#rrggbb", [r,g,b] in [0, 1] (sRGB), or {"linear":[r,g,b]})");
}

/// Both hexadecimal digits at text[i]; -1 where one is none.
int hex_byte(const std::string& text, std::size_t i) {
  int byte = 0;
  for (const char c : {text[i], text[i + 1]}) {
    const int digit = c >= '0' && c <= '9'   ? c - '0'
                      : c >= 'a' && c <= 'f' ? c - 'a' + 10
                      : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                             : -1;
    if (digit < 0) return -1;
    byte = byte * 16 + digit;
  }
  return byte;
}

}  // namespace

Color read_color(const json& value, const std::string& where) {
  Color color;
  if (value.is_string()) {
    const auto& text = value.get_ref<const std::string&>();
    if (text.size() != 7 || text[0] != '#') fail_color(value, where);
    for (std::size_t c = 0; c < 3; ++c) {
      const int byte = hex_byte(text, 1 + 2 * c);
      if (byte < 0) fail_color(value, where);
      color.linear[c] = linear_from_srgb(static_cast<float>(byte) / 255.0f);
    }
    return color;
  }
  const bool linear = value.is_object() && value.size() == 1 && value.contains("linear");
  const json& channels = linear ? value["linear"] : value;
  if (!channels.is_array() || channels.size() != 3) fail_color(value, where);
  for (std::size_t c = 0; c < 3; ++c) {
    if (!channels[c].is_number()) fail_color(channels[c], where);
    const auto x = channels[c].get<double>();
    if (!std::isfinite(x) || std::abs(x) > kLargestNumber) fail_color(channels[c], where);
    if (!linear && !(x >= 0 && x <= 1)) fail_color(channels[c], where);
    color.linear[c] = linear ? static_cast<float>(x) : linear_from_srgb(static_cast<float>(x));
  }
  return color;
}

void FieldReader::read(const json& value, const FieldInfo& info, const std::string& where, double& out) {
  if (!value.is_number()) {
    const std::string range = range_text(info.range);
    fail(value, where, "a number" + (range.empty() ? "" : " " + range));
  }
  out = value.get<double>();
}

void FieldReader::read(const json& value, const FieldInfo&, const std::string& where, bool& out) {
  if (!value.is_boolean()) fail(value, where, "true or false");
  out = value.get<bool>();
}

void FieldReader::read(const json& value, const FieldInfo& info, const std::string& where, std::string& out) {
  if (!value.is_string())
    fail(value, where, info.words ? "one of " + join_words(info.words->available) : "text");
  out = value.get<std::string>();
  if (out.size() > 4096) fail(value, where, "at most 4096 bytes of text");
  for (const char c : out) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F)
      fail(value, where, "text without control characters");
  }
}

void FieldReader::read(const json& value, const FieldInfo& info, const std::string& where,
                       AnimationKey& out) {
  if (!value.is_array() || value.size() != 2) fail(value, where, "a key: [seconds, value]");
  read(value[0], info, child_address(where, "0"), out.time_s);
  const std::string address = child_address(where, "1");
  const json& of_field = value[1];
  const auto read_as = [&]<class T>(T shape) {
    // A null stands for the open end of a clip box; fields that have none refuse it later.
    read(of_field, FieldInfo{.key = "", .doc = "", .range = kAnyFace, .max_count = 65536, .open_ended = true},
         address, shape);
    out.value = std::move(shape);
  };
  if (of_field.is_number()) return read_as(double{});
  if (of_field.is_boolean()) return read_as(bool{});
  if (of_field.is_string()) return read_as(std::string{});
  if (of_field.is_object()) return read_as(Color{});
  if (!of_field.is_array()) fail(of_field, address, "a value of the field");
  const bool points = !of_field.empty() && of_field[0].is_object();
  points ? read_as(std::vector<TransferPoint>{}) : read_as(std::vector<double>{});
}

void FieldReader::check_keys(const json& object, const std::string& where,
                             const std::vector<std::string_view>& known) {
  for (const auto& [key, value] : object.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string nearest = nearest_word(key, known);
    throw Error(ErrorCode::kBadParameter, where,
                "unknown key " + quote_text(key) + "; " +
                    (nearest.empty() ? "expected one of " + join_words(known)
                                     : "did you mean " + quote_text(nearest) + "?"));
  }
}

void FieldReader::fail(const json& found, const std::string& where, const std::string& expected) {
  throw Error(ErrorCode::kBadParameter, where, "found " + describe_json(found) + ", expected " + expected);
}

}  // namespace voxlume
