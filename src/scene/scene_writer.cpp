#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <functional>

#include "base/atomic_file.h"
#include "scene/field_writer.h"
#include "scene/scene_file.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;

std::string print_inline(const OrderedJson& value) {
  if (value.is_number_float()) {
    // 5, not 5.0; beyond 2^53 digits would be invented.
    const auto x = value.get<double>();
    const bool whole = std::abs(x) < 9e15 && x == std::floor(x) && !(x == 0 && std::signbit(x));
    return whole ? std::to_string(static_cast<std::int64_t>(x)) : value.dump();
  }
  if (!value.is_structured()) return value.dump();
  std::string out;
  for (const auto& [key, element] : value.items()) {
    if (!out.empty()) out += ", ";
    if (value.is_object()) out += OrderedJson(key).dump() + ": ";
    out += print_inline(element);
  }
  return value.is_object() ? "{" + out + "}" : "[" + out + "]";
}

void print(const OrderedJson& value, std::size_t indent, std::size_t key_width, std::string& out) {
  constexpr std::size_t kColumns = 100;
  const std::string line = print_inline(value);
  if (!value.is_structured() || value.empty() ||
      (indent > 0 && indent + key_width + line.size() < kColumns)) {
    out += line;
    return;
  }
  const std::string inner(indent + 2, ' ');
  out += value.is_object() ? "{\n" : "[\n";
  bool first = true;
  for (const auto& [key, element] : value.items()) {
    if (!first) out += ",\n";
    first = false;
    const std::string label = value.is_object() ? OrderedJson(key).dump() + ": " : "";
    out += inner + label;
    print(element, indent + 2, label.size(), out);
  }
  out += '\n' + std::string(indent, ' ') + (value.is_object() ? '}' : ']');
}

/// The double with the fewest digits that becomes `x` when read as a double and rounded to float.
double shortest_double(float x) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, x).ptr;
  double value = x;
  std::from_chars(text, end, value);
  return static_cast<float>(value) == x ? value : static_cast<double>(x);
}

template <class T>
void visit_paths(T&, const std::function<void(std::string&)>&) {}
template <OptionalField T>
void visit_paths(T& value, const std::function<void(std::string&)>& change);
template <ListField T>
void visit_paths(T& value, const std::function<void(std::string&)>& change);
template <StructField T>
void visit_paths(T& value, const std::function<void(std::string&)>& change) {
  visit_fields(
      [&](const FieldInfo& info, auto member) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value.*member)>, std::string>) {
          if (info.is_path && !(value.*member).empty()) change(value.*member);
        } else {
          visit_paths(value.*member, change);
        }
      },
      Struct<T>{});
}
template <OptionalField T>
void visit_paths(T& value, const std::function<void(std::string&)>& change) {
  if (value) visit_paths(*value, change);
}
template <ListField T>
void visit_paths(T& value, const std::function<void(std::string&)>& change) {
  for (auto& element : value) visit_paths(element, change);
}

/// `path` as a scene in `folder` names it. Both are absolute.
std::string path_from(const fs::path& folder, const fs::path& path) {
  const fs::path relative = path.lexically_relative(folder);
  const bool inside = !relative.empty() && *relative.begin() != "..";
  // A file really called "phantom" must not turn into the built-in volume.
  if (inside && relative.string() != kPhantomPath) return relative.generic_string();
  return path.string();
}

}  // namespace

OrderedJson color_json(const Color& color) {
  OrderedJson channels = OrderedJson::array();
  for (const float x : color.linear) channels.push_back(shortest_double(x));
  return {{"linear", channels}};
}

std::string print_json(const OrderedJson& value) {
  std::string out;
  print(value, 0, 0, out);
  return out + '\n';
}

std::string write_scene(const SceneDescription& scene, bool all_fields) {
  try {
    OrderedJson root = FieldWriter{all_fields}.json(scene);
    if (!all_fields) {
      // A struct that is not at its default, but has nothing to write, is noise.
      for (auto it = root.begin(); it != root.end();) {
        const bool optional = it.key() == "labels" || it.key() == "environment" || it.key() == "clip" ||
                              it.key() == "illustration" || it.key() == "visibility" ||
                              it.key() == "animation";
        it = !optional && it->is_object() && it->empty() ? root.erase(it) : std::next(it);
      }
    }
    return print_json(root);
  } catch (const nlohmann::json::exception& e) {
    throw Error(ErrorCode::kBadParameter, "", "the scene holds text that is not UTF-8");
  }
}

void save_scene(const SceneDescription& scene, const fs::path& path, bool all_fields) {
  SceneDescription placed = scene;
  const fs::path folder = fs::absolute(path).lexically_normal().parent_path();
  for_each_path(placed, [&](std::string& p) { p = path_from(folder, fs::absolute(p).lexically_normal()); });
  write_file_atomically(path, write_scene(placed, all_fields));
}

void for_each_path(SceneDescription& scene, const std::function<void(std::string&)>& change) {
  const auto skip_phantom = [&](std::string& path) {
    if (path != kPhantomPath) change(path);
  };
  visit_paths(scene, skip_phantom);
}

}  // namespace voxlume
