#include "server/messages.h"

#include <cmath>

#include "base/fail.h"
#include "scene/field_info.h"
#include "voxlume/error.h"

namespace voxlume::server {
namespace {

using nlohmann::json;

constexpr int kMostDepth = 32;
constexpr std::size_t kMostName = 4096;

[[noreturn]] void refuse(const std::string& where, const std::string& message) {
  throw Error(ErrorCode::kBadParameter, where, message);
}

json parse_object(std::string_view text) {
  const auto watch = [](int depth, json::parse_event_t event, json&) {
    const bool opens =
        event == json::parse_event_t::object_start || event == json::parse_event_t::array_start;
    if (opens && depth >= kMostDepth) throw Error(ErrorCode::kBadFormat, "", "nested too deeply");
    return true;
  };
  json message;
  try {
    message = json::parse(text.begin(), text.end(), watch);
  } catch (const json::exception& error) {
    throw Error(ErrorCode::kBadFormat, "", "expected JSON: " + one_line(error.what()));
  }
  if (!message.is_object()) throw Error(ErrorCode::kBadFormat, "", "expected a JSON object");
  return message;
}

const json& member(const json& message, const char* name) {
  const auto found = message.find(name);
  if (found == message.end()) refuse(std::string("/") + name, "is missing");
  return *found;
}

std::string text(const json& value, const std::string& where) {
  if (!value.is_string()) refuse(where, "expected text");
  const auto& out = value.get_ref<const std::string&>();
  if (out.size() > kMostName) refuse(where, "expected at most 4096 bytes");
  return out;
}

std::string optional_text(const json& message, const char* name) {
  return message.contains(name) ? text(message[name], std::string("/") + name) : std::string();
}

double number(const json& value, const std::string& where, double lower, double upper) {
  if (!value.is_number()) refuse(where, "expected a number");
  const auto x = value.get<double>();
  if (!(x >= lower && x <= upper)) refuse(where, "out of range");
  return x;
}

/// What a double holds exactly.
std::int64_t whole(const json& value, const std::string& where) {
  constexpr double kMost = 9007199254740991.0;
  const double x = number(value, where, -kMost, kMost);
  if (x != std::floor(x)) refuse(where, "expected a whole number");
  return static_cast<std::int64_t>(x);
}

std::optional<double> number_or_null(const json& message, const char* name, double lower, double upper) {
  const json& value = member(message, name);
  if (value.is_null()) return std::nullopt;
  return number(value, std::string("/") + name, lower, upper);
}

std::vector<FieldEdit> fields(const json& message) {
  std::vector<FieldEdit> out;
  const json& set = member(message, "set");
  if (!set.is_array()) refuse("/set", "expected a list of [address, value]");
  for (std::size_t i = 0; i < set.size(); ++i) {
    const std::string where = "/set/" + std::to_string(i);
    if (!set[i].is_array() || set[i].size() != 2) refuse(where, "expected [address, value]");
    out.emplace_back(text(set[i][0], where + "/0"), set[i][1]);
  }
  return out;
}

LoadMessage read_load(const json& message) {
  const json& scene = member(message, "scene");
  if (!scene.is_object()) refuse("/scene", "expected an object");
  return {scene};
}

Vec3d position(const json& value, const std::string& where) {
  if (!value.is_array() || value.size() != 3) refuse(where, "expected three numbers");
  const auto coordinate = [&](std::size_t i) {
    return number(value[i], where + "/" + std::to_string(i), -kLargestNumber, kLargestNumber);
  };
  return {coordinate(0), coordinate(1), coordinate(2)};
}

ProbeMessage read_probe(const json& message) {
  if (message.contains("position_mm"))
    return {whole(member(message, "id"), "/id"), 0, 0, position(message["position_mm"], "/position_mm")};
  return {whole(member(message, "id"), "/id"), number(member(message, "x"), "/x", 0, 1),
          number(member(message, "y"), "/y", 0, 1)};
}

}  // namespace

PageMessage parse_message(std::string_view frame) {
  const json message = parse_object(frame);
  const std::string type = text(member(message, "type"), "/type");
  if (type == "edit")
    return EditMessage{whole(member(message, "seq"), "/seq"), fields(message),
                       optional_text(message, "gesture")};
  if (type == "passing") return PassingMessage{whole(member(message, "seq"), "/seq"), fields(message)};
  if (type == "undo") return UndoMessage{};
  if (type == "redo") return RedoMessage{};
  if (type == "load") return read_load(message);
  if (type == "open") return OpenMessage{text(member(message, "path"), "/path")};
  if (type == "cancel_open") return CancelOpenMessage{};
  if (type == "split") return SplitMessage{number_or_null(message, "at", 0, 1)};
  if (type == "seek") return SeekMessage{number_or_null(message, "time_s", 0, 1e9)};
  if (type == "probe") return read_probe(message);
  if (type == "export") return ExportMessage{text(member(message, "file"), "/file")};
  if (type == "cancel_export") return CancelExportMessage{};
  if (type == "draw_presets") return DrawPresetsMessage{};
  if (type == "shown")
    return ShownMessage{
        static_cast<std::uint64_t>(number(member(message, "frame"), "/frame", 0, 9007199254740991.0))};
  refuse("/type", "found " + quote_text(type) + ", which no page says");
}

std::optional<std::int64_t> seq_of(std::string_view frame) {
  try {
    const json message = parse_object(frame);
    return whole(member(message, "seq"), "/seq");
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::string text_of(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace voxlume::server
