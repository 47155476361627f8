#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "scene/field_writer.h"
#include "scene/scene_schema.h"

namespace voxlume {
namespace {

constexpr const char* kIntroduction = R"(# The scene file

A scene is one JSON file: everything a picture is made from. `voxlume render scene.json -o out.png` renders it, flags
override single fields, and `--save-scene` writes the scene a command line amounts to. This page is printed by
`voxlume schema --markdown`, the JSON Schema (draft 2020-12) by `voxlume schema`; both come from the table by which
files are read.

```json
{
  "version": 1,
  "volume": {"path": "head-ct.nrrd"},
  "transfer": {
    "points": [
      {"value": 150, "opacity": 0},
      {"value": 300, "opacity": 0.9, "color": "#e8dcc8"}
    ]
  },
  "lights": [{"kind": "directional", "direction": [-0.5, -0.6, 0.75], "intensity": 3}],
  "camera": {"azimuth_deg": 30, "elevation_deg": 10},
  "image": {"width": 800, "height": 600, "spp": 256}
}
```

Rules:

- `version` is required. A file of a newer version is refused.
- A key that is not listed here is an error; so is a key given twice.
- Only what differs from the defaults need be written.
- Relative paths start from the scene file's own folder.
- Positions are in the volume's physical space, LPS: x toward the patient's left, y toward posterior, z toward the
  head; millimetres. Directions are LPS as well. Data values are in the file's own units.
- A color is `"#rrggbb"` or `[r, g, b]` in [0, 1], both sRGB-encoded, or `{"linear": [r, g, b]}` for linear Rec. 709,
  where channels may exceed 1 if the field's range allows. Ranges of colors hold for the linear channels.
- Numbers are finite and of magnitude at most 1e12 unless a range says otherwise.
)";

template <class T>
std::string type_text(const FieldInfo& info) {
  if constexpr (OptionalField<T>) {
    return type_text<typename T::value_type>(info);
  } else if constexpr (StructField<T>) {
    const std::string name = struct_info(Struct<T>{}).name;
    std::string anchor;
    for (const char c : name) anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return fmt::format("[{}](#{})", name, anchor);
  } else if constexpr (ListField<T>) {
    return "list of " + type_text<typename T::value_type>(info);
  } else if constexpr (TupleField<T>) {
    return fmt::format("{} numbers{}", std::tuple_size_v<T>, info.open_ended ? " or null" : "");
  } else if constexpr (EnumField<T>) {
    return fmt::format("`{}`", fmt::join(EnumWords<T>::kWords, "` `"));
  } else if constexpr (std::is_same_v<T, Color>) {
    return "color";
  } else if constexpr (std::is_same_v<T, AnimationKey>) {
    return "[time, value]";
  } else if constexpr (std::is_same_v<T, bool>) {
    return "true, false";
  } else if constexpr (std::is_same_v<T, std::string>) {
    return info.words     ? fmt::format("`{}`", fmt::join(info.words->available, "` `"))
           : info.is_path ? "path"
                          : "text";
  } else {
    return IntegerField<T> ? "whole number" : "number";
  }
}

/// Text for a cell of a table.
std::string cell(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '|' ? "\\|" : std::string(1, c);
  return out;
}

/// Printed JSON as a cell of a table can hold it.
std::string on_one_line(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\n') {
      out += text[i];
      continue;
    }
    while (i + 1 < text.size() && text[i + 1] == ' ') ++i;
    if (out.ends_with(',')) out += ' ';
  }
  return out;
}

template <class M, StructField T>
std::string default_text(const FieldInfo& info, M T::*member) {
  if (info.required) return "required";
  if constexpr (OptionalField<M>) return *info.absent ? std::string("absent: ") + info.absent : "absent";
  if constexpr (StructField<M>) return "";
  if constexpr (!OptionalField<M> && !StructField<M>) {
    return "`" + on_one_line(print_json(FieldWriter{}.json(T{}.*member, info))) + "`";
  }
}

/// The sections still to be written, in the order in which they are first mentioned.
struct Sections {
  std::vector<std::string> names;
  std::string text;

  template <class T>
  void add() {
    if constexpr (OptionalField<T> || ListField<T>) {
      add<typename T::value_type>();
    } else if constexpr (StructField<T>) {
      add_struct<T>();
    }
  }

  template <StructField T>
  void add_struct() {
    const StructInfo title = struct_info(Struct<T>{});
    if (std::find(names.begin(), names.end(), title.name) != names.end()) return;
    names.push_back(title.name);
    text += fmt::format(
        "\n## {}\n\n{}\n\n| key | type | range, unit | default | meaning |\n|---|---|---|---|---|\n",
        title.name, title.doc);
    visit_fields(
        [&]<class M>(const FieldInfo& info, M T::*member) {
          std::string range = range_text(info.range);
          if (*info.unit) range += (range.empty() ? "" : " ") + std::string(info.unit);
          text += fmt::format("| `{}` | {} | {} | {} | {} |\n", info.key, type_text<M>(info), range,
                              default_text(info, member), cell(info.doc));
        },
        Struct<T>{});
    visit_fields([&]<class M>(const FieldInfo&, M T::*) { add<M>(); }, Struct<T>{});
  }
};

}  // namespace

std::string scene_reference_markdown() {
  Sections sections;
  sections.add_struct<SceneDescription>();
  return kIntroduction + sections.text;
}

}  // namespace voxlume
