#include "scene/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/animation.h"
#include "scene/field_check.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& message) {
  throw Error(ErrorCode::kBadParameter, where, message);
}

/// `found`: what is refused; a bound that it exceeds is named, though it be that of all numbers.
std::string expected_number(const char* noun, const FieldInfo& info, double found) {
  const NumberRange& all = info.range;
  const std::string range =
      found > all.upper && all.bounded_below() && !all.bounded_above()
          ? fmt::format("in {}{}, {}]", all.open_lower ? '(' : '[', all.lower, all.upper)
          : range_text(all);
  if (range.empty())
    return fmt::format("a finite {} of magnitude at most {}", noun, std::max(all.upper, kLargestNumber));
  return fmt::format("a {} {}", noun, range);
}

void check_points(const TransferDescription& transfer, const std::string& where) {
  const std::string list = child_address(where, "points");
  bool by_opacity = false, by_extinction = false;
  for (std::size_t i = 0; i < transfer.points.size(); ++i) {
    const TransferPoint& point = transfer.points[i];
    const std::string address = child_address(list, std::to_string(i));
    if (i > 0 && point.value < transfer.points[i - 1].value) {
      refuse(address, fmt::format("found value {} after {}, expected points sorted by value", point.value,
                                  transfer.points[i - 1].value));
    }
    if (!point.material.empty())
      refuse(child_address(address, "material"),
             "found a material, which rules of kind mpctf and mdptf give alone");
    by_opacity |= point.opacity.has_value();
    by_extinction |= point.mu_t_per_mm.has_value();
    if (by_opacity && by_extinction) {
      refuse(address, "found both opacity and mu_t_per_mm in one transfer function, expected one of them");
    }
  }
}

/// Values in order, as floats, which they are looked up as. `value` takes an element.
template <class List, class Value>
void check_order(const List& list, Value&& value, bool may_repeat, const std::string& where,
                 const char* key) {
  for (std::size_t i = 1; i < list.size(); ++i) {
    const double before = value(list[i - 1]), after = value(list[i]);
    const auto a = static_cast<float>(before), b = static_cast<float>(after);
    if (b < a || (b == a && !may_repeat))
      refuse(child_address(child_address(where, std::to_string(i)), key),
             fmt::format("found {} after {}, expected values sorted{}", after, before,
                         may_repeat ? "" : " and no two alike"));
  }
}

void check_rule(const RuleDescription& rule, const std::string& where) {
  const bool curve = rule.kind == RuleKind::kCoefficientCurve;
  const auto check = [&](const std::vector<TransferPoint>& points, const std::string& of) {
    check_order(
        points, [](const TransferPoint& p) { return p.value; }, curve, child_address(of, "points"), "value");
  };
  check(rule.points, where);
  const std::string columns = child_address(where, "columns");
  check_order(
      rule.columns, [](const RuleColumn& c) { return c.at; }, false, columns, "at");
  for (std::size_t i = 0; i < rule.columns.size(); ++i)
    check(rule.columns[i].points, child_address(columns, std::to_string(i)));
}

void check_direction(const std::optional<Double3>& v, const std::string& where) {
  if (v && std::hypot((*v)[0], (*v)[1], (*v)[2]) < 1e-12)
    refuse(where, "found a zero vector, expected a direction");
}

void check_light(const LightDescription& light, const std::string& where) {
  const std::string kind(enum_word(light.kind));
  const auto need = [&](bool given, const char* key) {
    if (!given) refuse(where, fmt::format("missing key \"{}\", which a {} light needs", key, kind));
  };
  const auto no_use = [&](bool given, const char* key) {
    if (given) refuse(child_address(where, key), fmt::format("a {} light has none", kind));
  };
  const bool directional = light.kind == LightKind::kDirectional, rect = light.kind == LightKind::kRect;
  if (directional) need(light.direction.has_value(), "direction");
  if (!directional) need(light.position_mm.has_value(), "position_mm");
  no_use(!directional && light.direction, "direction");
  no_use(directional && light.position_mm, "position_mm");
  no_use(!rect && light.target_mm, "target_mm");
  no_use(!rect && light.up, "up");
  check_direction(light.direction, child_address(where, "direction"));
  check_direction(light.up, child_address(where, "up"));
  if (rect && light.target_mm && *light.target_mm == *light.position_mm) {
    refuse(child_address(where, "target_mm"), "found the light's own position, expected another point");
  }
}

void check_illustration(const IllustrationDescription& illustration, const std::string& where) {
  check_direction(illustration.direction, child_address(where, "direction"));
  const std::string list = child_address(where, "ramp");
  for (std::size_t i = 1; i < illustration.ramp.size(); ++i)
    if (illustration.ramp[i].value < illustration.ramp[i - 1].value)
      refuse(child_address(list, std::to_string(i)), "expected points sorted by value");
}

void check_importance(const ImportanceDescription& important, const std::string& where) {
  const auto refuse_key = [&](const char* key, const char* why) { refuse(child_address(where, key), why); };
  const auto check_range = [&](const std::optional<std::array<double, 2>>& range, const char* key) {
    if (range && !((*range)[0] <= (*range)[1]))
      refuse_key(key, "found a range that ends before it begins, expected lower <= upper");
  };
  check_range(important.range, "range");
  check_range(important.along_range, "along_range");
  if (important.along_range && important.along.empty())
    refuse_key("along", "missing, expected the volume that along_range is of");
  if (important.center_mm && important.radius_mm.has_value() == important.size_mm.has_value())
    refuse_key("center_mm", "expected either radius_mm or size_mm with it");
  if (!important.center_mm && (important.radius_mm || important.size_mm))
    refuse_key("center_mm", "missing, expected the middle of the region");
  if (!important.range && !important.along_range && !important.center_mm)
    refuse(where, "says nothing, expected a range or a region");
}

void check_clip(const ClipDescription& clip, const std::string& where) {
  const auto check = [&](const std::array<double, 2>& range, const char* key) {
    if (!(range[0] < range[1])) {
      refuse(child_address(where, key),
             fmt::format("found [{}, {}], expected lower < upper", range[0], range[1]));
    }
  };
  check(clip.x_mm, "x_mm");
  check(clip.y_mm, "y_mm");
  check(clip.z_mm, "z_mm");
}

void check_camera(const CameraDescription& camera, const std::string& where) {
  check_direction(camera.up, child_address(where, "up"));
  if (camera.eye_mm && camera.target_mm && *camera.eye_mm == *camera.target_mm) {
    refuse(child_address(where, "eye_mm"), "found the camera's target, expected another point");
  }
}

void check_image(const ImageDescription& image, const std::string& where) {
  for (std::size_t i = 0; i < image.aovs.size(); ++i) {
    if (std::find(image.aovs.begin(), image.aovs.begin() + i, image.aovs[i]) != image.aovs.begin() + i) {
      refuse(child_address(child_address(where, "aovs"), std::to_string(i)),
             "found " + quote_text(image.aovs[i]) + " twice");
    }
  }
}

}  // namespace

std::string child_address(const std::string& where, std::string_view key) {
  std::string out = where;
  if (out.empty() || out.back() != '/') out += '/';
  return out += key;
}

void check_field(double value, const FieldInfo& info, const std::string& where) {
  if (info.range.contains(value)) return;
  refuse(where, fmt::format("found {}, expected {}", value, expected_number("number", info, value)));
}

void check_integer(std::int64_t value, const FieldInfo& info, const std::string& where) {
  if (info.range.contains(static_cast<double>(value))) return;
  refuse(where, fmt::format("found {}, expected {}", value, expected_number("whole number", info, value)));
}

void check_field(const Color& value, const FieldInfo& info, const std::string& where) {
  for (const float channel : value.linear) {
    if (info.range.contains(channel)) continue;
    refuse(where, fmt::format("found a linear channel of {}, expected {}", channel,
                              expected_number("number", info, channel)));
  }
}

void check_field(const std::string& value, const FieldInfo& info, const std::string& where) {
  if (!info.words) return;
  const auto& available = info.words->available;
  if (std::find(available.begin(), available.end(), value) != available.end()) return;
  const auto& planned = info.words->planned;
  if (std::find(planned.begin(), planned.end(), value) != planned.end()) {
    throw Error(ErrorCode::kUnsupported, where,
                value + " is not built yet; available: " + join_words(available));
  }
  refuse(where, "found " + quote_text(value) + ", expected one of " + join_words(available));
}

void check_field(const AnimationKey& value, const FieldInfo& info, const std::string& where) {
  check_field(value.time_s, info, child_address(where, "0"));
}

void fail_count(std::size_t count, const FieldInfo& info, const std::string& where) {
  refuse(where, fmt::format("found {} elements, expected at most {}", count, info.max_count));
}

void validate_scene(const SceneDescription& scene, const std::string& where) {
  check_field(scene, FieldInfo{.key = "", .doc = ""}, where);
  const auto at = [&](const char* key) { return child_address(where, key); };
  check_points(scene.transfer, at("transfer"));
  for (std::size_t i = 0; i < scene.transfer.rules.size(); ++i)
    check_rule(scene.transfer.rules[i], child_address(at("transfer/rules"), std::to_string(i)));
  if (scene.labels && scene.labels->path.empty()) refuse(at("labels/path"), "found \"\", expected a file");
  if (scene.lights) {
    for (std::size_t i = 0; i < scene.lights->size(); ++i) {
      check_light((*scene.lights)[i], child_address(at("lights"), std::to_string(i)));
    }
  }
  if (scene.illustration) check_illustration(*scene.illustration, at("illustration"));
  if (scene.visibility)
    for (std::size_t i = 0; i < scene.visibility->important.size(); ++i)
      check_importance(scene.visibility->important[i],
                       child_address(child_address(at("visibility"), "important"), std::to_string(i)));
  check_camera(scene.camera, at("camera"));
  if (scene.clip) check_clip(*scene.clip, at("clip"));
  check_image(scene.image, at("image"));
  if (scene.animation) check_animation(*scene.animation, at("animation"));
}

}  // namespace voxlume
