#include "scene/scene_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <system_error>

#include "scene/field_reader.h"
#include "scene/validate.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kMaxDepth = 16;

/// "line 3, column 7" of a byte of the text.
std::string line_and_column(std::string_view text, std::size_t byte) {
  const std::string_view before = text.substr(0, std::min(byte, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n') + 1;  // npos + 1 is 0
  return fmt::format("line {}, column {}", line, before.size() - start + 1);
}

/// What the JSON library says, without its prefix, on one printable line.
std::string syntax_message(const std::string& what) {
  const std::size_t start = what.find(" - ");
  std::string text = start == std::string::npos ? what : what.substr(start + 3);
  std::string out;
  for (const char c : text) {
    if (out.size() > 160) return out + "...";
    out += static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7E ? '?' : c;
  }
  return out;
}

/// Parses JSON of bounded depth without repeated keys.
json parse_json(std::string_view text, const std::string& where) {
  std::vector<std::set<std::string>> keys;
  const auto watch = [&](int depth, json::parse_event_t event, json& parsed) {
    if (event == json::parse_event_t::object_start || event == json::parse_event_t::array_start) {
      if (depth >= kMaxDepth) {
        throw Error(ErrorCode::kBadFormat, where, fmt::format("nested more than {} deep", kMaxDepth));
      }
    }
    if (event == json::parse_event_t::object_start) keys.emplace_back();
    if (event == json::parse_event_t::object_end) keys.pop_back();
    if (event == json::parse_event_t::key && !keys.back().insert(parsed.get<std::string>()).second) {
      throw Error(
          ErrorCode::kBadFormat, where,
          "found the key " + quote_text(parsed.get_ref<const std::string&>()) + " twice in one object");
    }
    return true;
  };
  try {
    return json::parse(text.begin(), text.end(), watch);
  } catch (const json::parse_error& e) {
    // The library counts the offending byte from 1.
    const std::size_t byte = e.byte > 0 ? e.byte - 1 : 0;
    throw Error(ErrorCode::kBadFormat, where + ": " + line_and_column(text, byte), syntax_message(e.what()));
  } catch (const json::exception& e) {
    // A number such as 1e999.
    const std::string what = e.what();
    throw Error(ErrorCode::kBadFormat, where, syntax_message(what.substr(what.find("] ") + 2)));
  }
}

/// Refuses scenes of other versions before anything else of them is looked at.
void check_version(const json& root, const std::string& where) {
  if (!root.is_object()) {
    throw Error(ErrorCode::kBadFormat, where, "found " + describe_json(root) + ", expected an object");
  }
  const auto version = root.find("version");
  if (version == root.end()) {
    throw Error(ErrorCode::kBadParameter, where,
                fmt::format("missing key \"version\"; this program writes version {}", kSceneVersion));
  }
  int number = 0;
  FieldReader::read(*version, FieldInfo{.key = "version", .doc = "", .range = at_least(1)}, where + "version",
                    number);
  if (number > kSceneVersion) {
    throw Error(ErrorCode::kUnsupported, where + "version",
                fmt::format("found version {}, expected at most {}: the scene is from a newer voxlume",
                            number, kSceneVersion));
  }
}

}  // namespace

SceneDescription parse_scene(std::string_view text, const std::string& where) {
  if (text.size() > kMaxSceneBytes) {
    throw Error(ErrorCode::kBadFormat, where,
                fmt::format("{} bytes; expected a scene of at most {}", text.size(), kMaxSceneBytes));
  }
  json root = parse_json(text, where);
  const std::string root_address = where + ": /";
  check_version(root, root_address);
  root.erase("$schema");
  SceneDescription scene;
  FieldReader::read(root, FieldInfo{.key = "", .doc = ""}, root_address, scene);
  validate_scene(scene, root_address);
  return scene;
}

SceneDescription read_scene(const fs::path& path) {
  const std::string where = path.string();
  std::error_code ignored;
  if (fs::is_directory(path, ignored))
    throw Error(ErrorCode::kFileNotFound, where, "is a folder, not a scene file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorCode::kFileNotFound, where, std::strerror(errno));
  std::string text;
  std::vector<char> block(1 << 16);
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > kMaxSceneBytes) break;
  }
  SceneDescription scene = parse_scene(text, where);
  for_each_path(scene, [&](std::string& p) {
    if (fs::path(p).is_relative()) p = (path.parent_path() / p).lexically_normal().string();
  });
  return scene;
}

}  // namespace voxlume
