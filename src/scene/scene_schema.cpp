#include "scene/scene_schema.h"

#include "scene/field_writer.h"

namespace voxlume {
namespace {

void add_range(OrderedJson& schema, const NumberRange& range) {
  if (range.bounded_below()) schema[range.open_lower ? "exclusiveMinimum" : "minimum"] = range.lower;
  if (range.bounded_above()) schema[range.open_upper ? "exclusiveMaximum" : "maximum"] = range.upper;
}

std::string description(const FieldInfo& info) {
  std::string text = info.doc;
  if (*info.unit) text += " Unit: " + std::string(info.unit) + ".";
  if (*info.absent) text += " Absent: " + std::string(info.absent) + ".";
  return text;
}

OrderedJson reference(const char* name) { return {{"$ref", "#/$defs/" + std::string(name)}}; }

/// The schema of a value of type T, without description and default.
template <class T>
OrderedJson value_schema(const FieldInfo& info) {
  if constexpr (OptionalField<T>) {
    return value_schema<typename T::value_type>(info);
  } else if constexpr (StructField<T>) {
    return reference(struct_info(Struct<T>{}).name);
  } else if constexpr (ListField<T>) {
    return {{"type", "array"},
            {"items", value_schema<typename T::value_type>(info)},
            {"maxItems", info.max_count}};
  } else if constexpr (TupleField<T>) {
    const std::size_t count = std::tuple_size_v<T>;
    OrderedJson items = value_schema<typename T::value_type>(info);
    if (info.open_ended) items["type"] = {"number", "null"};
    return {{"type", "array"}, {"items", items}, {"minItems", count}, {"maxItems", count}};
  } else if constexpr (EnumField<T>) {
    return {{"enum", EnumWords<T>::kWords}};
  } else if constexpr (std::is_same_v<T, Color>) {
    return reference("Color");
  } else if constexpr (std::is_same_v<T, AnimationKey>) {
    return {{"type", "array"},
            {"prefixItems", {{{"type", "number"}}, OrderedJson::object()}},
            {"minItems", 2},
            {"maxItems", 2}};
  } else if constexpr (std::is_same_v<T, bool>) {
    return {{"type", "boolean"}};
  } else if constexpr (std::is_same_v<T, std::string>) {
    if (info.words) return {{"enum", info.words->available}};
    return {{"type", "string"}, {"maxLength", 4096}};
  } else {
    OrderedJson schema = {{"type", IntegerField<T> ? "integer" : "number"}};
    add_range(schema, info.range);
    if constexpr (IntegerField<T>) {
      if (!info.range.bounded_above()) schema["maximum"] = std::numeric_limits<T>::max();
    }
    return schema;
  }
}

template <StructField T>
void add_definition(OrderedJson& definitions);

/// Adds the definitions a value of type T refers to.
template <class T>
void add_referenced(OrderedJson& definitions) {
  if constexpr (OptionalField<T> || ListField<T>) {
    add_referenced<typename T::value_type>(definitions);
  } else if constexpr (StructField<T>) {
    add_definition<T>(definitions);
  }
}

template <StructField T>
OrderedJson struct_schema(OrderedJson& definitions) {
  OrderedJson properties = OrderedJson::object();
  OrderedJson required = OrderedJson::array();
  visit_fields(
      [&]<class M>(const FieldInfo& info, M T::*member) {
        OrderedJson property = value_schema<M>(info);
        property["description"] = description(info);
        if constexpr (!OptionalField<M> && !StructField<M>) {
          if (!info.required) property["default"] = FieldWriter{}.json(T{}.*member, info);
        }
        properties[info.key] = property;
        if (info.required) required.push_back(info.key);
        add_referenced<M>(definitions);
      },
      Struct<T>{});
  OrderedJson schema = {{"description", struct_info(Struct<T>{}).doc},
                        {"type", "object"},
                        {"properties", properties},
                        {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = required;
  return schema;
}

template <StructField T>
void add_definition(OrderedJson& definitions) {
  const char* const name = struct_info(Struct<T>{}).name;
  if (!definitions.contains(name)) definitions[name] = struct_schema<T>(definitions);
}

OrderedJson color_schema() {
  const OrderedJson channels = {
      {"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 3}, {"maxItems", 3}};
  OrderedJson encoded = channels;
  encoded["items"] = {{"type", "number"}, {"minimum", 0}, {"maximum", 1}};
  const OrderedJson linear = {{"type", "object"},
                              {"properties", {{"linear", channels}}},
                              {"required", {"linear"}},
                              {"additionalProperties", false}};
  return {{"description", "sRGB as \"#rrggbb\" or [r,g,b] in [0, 1], or linear Rec. 709."},
          {"oneOf", {{{"type", "string"}, {"pattern", "^#[0-9A-Fa-f]{6}$"}}, encoded, linear}}};
}

}  // namespace

std::string scene_schema() {
  OrderedJson definitions = {{"Color", color_schema()}};
  OrderedJson root = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                      {"title", "voxlume scene"}};
  OrderedJson scene = struct_schema<SceneDescription>(definitions);
  scene["properties"]["$schema"] = {{"description", "Address of this schema, for editors."},
                                    {"type", "string"}};
  for (const char* const name : {"TransferPoint", "NamedMaterial"})
    definitions[name]["not"] = {{"required", {"opacity", "mu_t_per_mm"}}};
  root.update(scene);
  root["$defs"] = definitions;
  return print_json(root);
}

}  // namespace voxlume
