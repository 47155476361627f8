#include "scene/material_library.h"

#include <algorithm>
#include <optional>
#include <string>

#include "scene/field_info.h"
#include "scene/field_types.h"
#include "scene/hex_color.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

/// What most materials are told by; the rest is set after.
LibraryMaterial material(const char* name, const char* summary, int color, double roughness, double specular,
                         double surface_share) {
  LibraryMaterial out;
  out.summary = summary;
  out.description.name = name;
  out.description.color = hex_color(color);
  out.description.roughness = roughness;
  out.description.specular = specular;
  out.description.surface_share = surface_share;
  return out;
}

LibraryMaterial metal(const char* name, const char* summary, int color, double roughness) {
  LibraryMaterial out = material(name, summary, color, roughness, 0.5, 1);
  out.description.metallic = 1;
  return out;
}

/// Light goes through: forward scattering, little surface.
LibraryMaterial translucent(LibraryMaterial out, double anisotropy) {
  out.description.anisotropy = anisotropy;
  return out;
}

std::vector<LibraryMaterial> make_library() {
  std::vector<LibraryMaterial> out;
  out.push_back(material("bone", "dry and warm, a little rough", 0xeee3cf, 0.5, 0.5, 1));
  out.back().description.diffuse_roughness = 0.4;
  out.push_back(material("tooth", "enamel: smooth and bright", 0xf9f5ec, 0.2, 0.6, 0.9));
  out.push_back(
      translucent(material("cartilage", "bluish white, translucent", 0xdfe6e8, 0.35, 0.5, 0.5), 0.6));
  out.push_back(translucent(material("skin", "soft, a little oily", 0xeec5ae, 0.45, 0.45, 0.7), 0.5));
  out.push_back(translucent(material("muscle", "dark red and moist", 0xb4564a, 0.3, 0.5, 0.7), 0.7));
  out.push_back(translucent(material("fat", "yellowish, translucent", 0xf2dfa2, 0.4, 0.4, 0.5), 0.7));
  out.push_back(translucent(material("vessel", "red, wet", 0xc22f28, 0.2, 0.6, 0.8), 0.5));
  out.push_back(translucent(material("vein", "blue, wet", 0x4a5f9e, 0.2, 0.6, 0.8), 0.5));
  out.push_back(translucent(material("brain", "pinkish grey, moist", 0xdcb9ae, 0.35, 0.5, 0.7), 0.6));
  out.push_back(material("lesion", "saturated orange, to be found", 0xf07a1c, 0.4, 0.5, 0.8));
  out.push_back(metal("metal", "brushed steel", 0xc8c8cc, 0.35));
  out.push_back(metal("gold", "polished gold", 0xffd77a, 0.2));
  out.push_back(metal("copper", "satin copper", 0xf0a882, 0.3));
  out.push_back(material("glass", "clear, smooth", 0xfafcfc, 0.05, 0.5, 1));
  out.back().description.transmission = 1;
  out.back().description.ior = 1.5;
  out.push_back(material("frosted-glass", "clear, rough", 0xf4fafa, 0.45, 0.5, 1));
  out.back().description.transmission = 1;
  out.back().description.ior = 1.5;
  out.push_back(
      translucent(material("wax", "light comes through from within", 0xf3e2b8, 0.45, 0.4, 0.35), 0.8));
  out.push_back(translucent(material("jade", "green, polished, translucent", 0x8fc7a0, 0.15, 0.6, 0.5), 0.6));
  out.push_back(material("plastic", "bright and smooth", 0xd8d8d8, 0.25, 0.5, 1));
  out.push_back(material("rubber", "dark and dull", 0x3a3a3c, 0.8, 0.3, 1));
  out.back().description.diffuse_roughness = 0.8;
  out.push_back(material("clay", "rough, without gloss", 0xb98a6a, 1, 0, 1));
  out.back().description.diffuse_roughness = 1;
  out.push_back(translucent(material("smoke", "no surface, forward scattering", 0xe8e8ea, 1, 0, 0), 0.4));
  out.push_back(translucent(
      material("cloud", "no surface, white; a backward lobe as of droplets", 0xffffff, 1, 0, 0), 0.85));
  out.back().description.back_anisotropy = -0.3;
  out.back().description.back_share = 0.1;
  return out;
}

/// Takes from `like` what `out` leaves open.
void fill_in(const NamedMaterialDescription& like, NamedMaterialDescription& out) {
  const bool has_extinction = out.opacity || out.mu_t_per_mm;
  const NamedMaterialDescription own = out;
  visit_fields(
      [&](const FieldInfo&, auto member) {
        if constexpr (OptionalField<std::remove_cvref_t<decltype(out.*member)>>)
          if (!(out.*member)) out.*member = like.*member;
      },
      Struct<NamedMaterialDescription>{});
  if (has_extinction) {
    out.opacity = own.opacity;
    out.mu_t_per_mm = own.mu_t_per_mm;
  }
}

const NamedMaterialDescription* find(const std::vector<NamedMaterialDescription>& materials,
                                     std::string_view name) {
  const auto at = std::find_if(materials.begin(), materials.end(),
                               [&](const NamedMaterialDescription& m) { return m.name == name; });
  return at == materials.end() ? nullptr : &*at;
}

}  // namespace

const std::vector<LibraryMaterial>& material_library() {
  static const std::vector<LibraryMaterial> library = make_library();
  return library;
}

std::vector<NamedMaterialDescription> all_materials(const std::vector<NamedMaterialDescription>& own) {
  std::vector<NamedMaterialDescription> library, out;
  std::vector<std::string_view> names;
  for (const LibraryMaterial& one : material_library()) {
    library.push_back(one.description);
    names.push_back(one.description.name);
  }
  for (std::size_t i = 0; i < own.size(); ++i) {
    const std::string where = "/materials/" + std::to_string(i);
    NamedMaterialDescription material = own[i];
    if (material.name.empty() || find(out, material.name))
      throw Error(ErrorCode::kBadParameter, where + "/name",
                  "found " + quote_text(material.name) + ", expected a name of its own");
    if (material.opacity && material.mu_t_per_mm)
      throw Error(ErrorCode::kBadParameter, where,
                  "found both opacity and mu_t_per_mm, expected one of them");
    if (!material.like.empty()) {
      const NamedMaterialDescription* like = find(library, material.like);
      if (!like)
        throw Error(ErrorCode::kBadParameter, where + "/like",
                    "found " + quote_text(material.like) + ", expected one of " + join_words(names));
      fill_in(*like, material);
    }
    out.push_back(material);
  }
  for (const NamedMaterialDescription& one : library)
    if (!find(out, one.name)) out.push_back(one);
  return out;
}

}  // namespace voxlume
