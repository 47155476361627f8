#pragma once
#include "scene/field_info.h"

namespace voxlume {

// Field tables (scene/field_table.h) of classification: transfer function, rules, further volumes, materials.

inline StructInfo struct_info(Struct<TransferPoint>) {
  return {"TransferPoint",
          "One control point. Every coefficient has its own piecewise-linear curve through the points that "
          "give it. A function uses opacity or mu_t_per_mm, not both."};
}
template <class V>
void visit_fields(V&& visit, Struct<TransferPoint>) {
  using T = TransferPoint;
  visit({.key = "value",
         .doc = "Data value in the file's own units (HU, intensity). Points are sorted by it; two at one "
                "value are a step.",
         .range = between(-3e38, 3e38),
         .required = true},
        &T::value);
  visit({.key = "opacity",
         .doc = "Opacity of a layer one reference length thick.",
         .range = between(0, 1),
         .absent = "the curve passes by"},
        &T::opacity);
  visit({.key = "mu_t_per_mm",
         .doc = "Extinction, instead of an opacity.",
         .unit = "1/mm",
         .range = at_least(0),
         .absent = "the curve passes by"},
        &T::mu_t_per_mm);
  visit(
      {.key = "color", .doc = "Scattering albedo.", .range = between(0, 1), .absent = "the curve passes by"},
      &T::color);
  visit({.key = "emission",
         .doc = "Emitted radiance of an opaque region.",
         .range = at_least(0),
         .absent = "the curve passes by"},
        &T::emission);
  visit({.key = "roughness",
         .doc = "Of the surface lobes: GGX alpha = roughness^2.",
         .range = between(0, 1),
         .absent = "the curve passes by"},
        &T::roughness);
  visit({.key = "metallic",
         .doc = "Share of metal among surface particles.",
         .range = between(0, 1),
         .absent = "the curve passes by"},
        &T::metallic);
  visit({.key = "specular",
         .doc = "Fresnel F0 = 0.08 specular of what is not metal.",
         .range = between(0, 1),
         .absent = "the curve passes by"},
        &T::specular);
  visit({.key = "anisotropy",
         .doc = "g of the Henyey-Greenstein phase function.",
         .range = inside(-1, 1),
         .absent = "the curve passes by"},
        &T::anisotropy);
  visit({.key = "surface_share",
         .doc = "Multiplies the share of the surface that follows from gradient and opacity.",
         .range = between(0, 1),
         .absent = "the curve passes by"},
        &T::surface_share);
  visit({.key = "extinction_color",
         .doc = "Multiplies the extinction of each channel, where render.extinction is rgb.",
         .range = between(0, 1),
         .absent = "the curve passes by; white where no point gives one"},
        &T::extinction_color);
  visit(
      {.key = "material",
       .doc = "Of rules mpctf and mdptf: the material, one of the scene's or of the library. What the point "
              "gives itself comes before the material's own."},
      &T::material);
}

inline StructInfo struct_info(Struct<ProxyDescription>) {
  return {"Proxy",
          "A volume beside the main one that rules read, in the same physical space on its own grid. Outside "
          "its grid it has no value, and rules do not apply."};
}
template <class V>
void visit_fields(V&& visit, Struct<ProxyDescription>) {
  using T = ProxyDescription;
  visit({.key = "name",
         .doc = "What rules call it. \"data\" is the main volume, \"opacity\" that of the transfer "
                "function's own points.",
         .required = true},
        &T::name);
  visit(
      {.key = "kind",
       .doc = "Read from a file, or derived from another volume: its gradient magnitude (per mm), the volume "
              "smoothed, or the signed distance (mm, positive inside) to the border of some labels."},
      &T::kind);
  visit({.key = "path", .doc = "file: volume file or folder.", .is_path = true}, &T::path);
  visit({.key = "of", .doc = "Derived: \"data\" or the name of a proxy further up in the list."}, &T::of);
  visit({.key = "sigma_mm",
         .doc = "smoothed: standard deviation of the Gaussian.",
         .unit = "mm",
         .range = above_to(0, 1e6)},
        &T::sigma_mm);
  visit({.key = "labels",
         .doc = "distance: the labels that are inside.",
         .range = between(-2147483648.0, 4294967295.0),
         .max_count = 65536},
        &T::labels);
  visit({.key = "lookup",
         .doc = "linear interpolates between voxels; nearest takes whole numbers as they are (labels)."},
        &T::lookup);
  visit({.key = "outline",
         .doc = "nearest: where labels end. smooth: where a smooth field between the voxels has it, without "
                "stairs; every voxel's centre keeps its label. voxels: at the voxels' faces."},
        &T::outline);
}

inline StructInfo struct_info(Struct<RuleColumn>) {
  return {"RuleColumn", "The function of a 2-D rule at one value of its second volume."};
}
template <class V>
void visit_fields(V&& visit, Struct<RuleColumn>) {
  using T = RuleColumn;
  visit({.key = "at",
         .doc = "Value of the second volume. Columns are sorted by it, no two alike.",
         .range = between(-3e38, 3e38),
         .required = true},
        &T::at);
  visit({.key = "points", .doc = "The function's points, sorted by value.", .max_count = 65536}, &T::points);
}

inline StructInfo struct_info(Struct<RuleDescription>) {
  return {
      "Rule",
      "A transfer function of one volume, by points, or of two, by columns. The five kinds of Xu et al. "
      "2025: coefficient curve (cctf), coefficient piecewise constant (cpctf), coefficient discrete point "
      "(cdptf), material piecewise constant (mpctf), material discrete point (mdptf). A rule of discrete "
      "points reads a volume whose lookup is nearest."};
}
template <class V>
void visit_fields(V&& visit, Struct<RuleDescription>) {
  using T = RuleDescription;
  visit({.key = "kind",
         .doc = "cctf is linear between points; with cpctf and mpctf a point holds up to the next one, and "
                "nothing does below the first; with cdptf and mdptf it holds at its value alone."},
        &T::kind);
  visit({.key = "volume",
         .doc = "What the points' values are of: \"data\", \"opacity\" or the name of a proxy."},
        &T::volume);
  visit({.key = "points", .doc = "1-D: the points, sorted by value.", .max_count = 65536}, &T::points);
  visit({.key = "along", .doc = "2-D: what the columns' values are of, as volume."}, &T::along);
  visit({.key = "column_form",
         .doc = "2-D: between columns the function is interpolated (curve, constant beyond the outermost), a "
                "column holds up to the next one (steps), or at its value alone (points)."},
        &T::column_form);
  visit({.key = "columns", .doc = "2-D: the columns.", .max_count = 4096}, &T::columns);
}

inline StructInfo struct_info(Struct<TransferDescription>) {
  return {"Transfer", "Data value to optical coefficients: the data is interpolated first, then classified."};
}
template <class V>
void visit_fields(V&& visit, Struct<TransferDescription>) {
  using T = TransferDescription;
  visit({.key = "preset", .doc = "Name of a preset (`voxlume presets`); used where points is empty."},
        &T::preset);
  visit({.key = "reference_length_mm",
         .doc = "Thickness an opacity refers to: mu_t = -ln(1 - min(opacity, 0.9999)) / reference_length_mm.",
         .unit = "mm",
         .range = above(0),
         .absent = "1 mm for CT, else longest side / 256"},
        &T::reference_length_mm);
  visit({.key = "density_scale", .doc = "Multiplies the extinction.", .range = between(0, 1e6)},
        &T::density_scale);
  visit({.key = "points", .doc = "Control points, sorted by value.", .max_count = 65536}, &T::points);
  visit(
      {.key = "rules",
       .doc = "Further transfer functions, of this and other volumes; points, if any, are the last of them.",
       .max_count = 16},
      &T::rules);
  visit(
      {.key = "merge",
       .doc = "How the rules become one. product: every coefficient is the product of the rules that give it "
              "(opacities are multiplied). priority: every coefficient is that of the first rule that "
              "applies and gives it; a rule applies where its opacity is above 0 or, if it gives none, "
              "where it has points. maximum: the same, the rule of the greatest extinction first."},
      &T::merge);
  visit({.key = "smooth_labels",
         .doc = "Normals at borders of labels come from a smoothed field; without, labels have no surface of "
                "their own."},
        &T::smooth_labels);
}

inline StructInfo struct_info(Struct<NamedMaterialDescription>) {
  return {"NamedMaterial",
          "A material that rules name. What is absent is that of `like`; what that does not give is the "
          "scene's material, and what rules give."};
}
template <class V>
void visit_fields(V&& visit, Struct<NamedMaterialDescription>) {
  using T = NamedMaterialDescription;
  constexpr const char* kAsLike = "that of like, else the rules' or the scene's";
  visit({.key = "name", .doc = "What rules call it.", .required = true}, &T::name);
  visit({.key = "like", .doc = "A material of the library (docs/materials.md)."}, &T::like);
  visit({.key = "opacity",
         .doc = "Opacity of a layer one reference length thick.",
         .range = between(0, 1),
         .absent = kAsLike},
        &T::opacity);
  visit({.key = "mu_t_per_mm",
         .doc = "Extinction, instead of an opacity.",
         .unit = "1/mm",
         .range = at_least(0),
         .absent = kAsLike},
        &T::mu_t_per_mm);
  visit({.key = "color", .doc = "Scattering albedo.", .range = between(0, 1), .absent = kAsLike}, &T::color);
  visit({.key = "emission",
         .doc = "Emitted radiance of an opaque region.",
         .range = at_least(0),
         .absent = kAsLike},
        &T::emission);
  const auto share = [&](const char* key, const char* doc, std::optional<double> T::*member) {
    visit({.key = key, .doc = doc, .range = between(0, 1), .absent = kAsLike}, member);
  };
  share("roughness", "Of the surface lobes: GGX alpha = roughness^2.", &T::roughness);
  share("metallic", "Share of metal among surface particles.", &T::metallic);
  share("specular", "Fresnel F0 = 0.08 specular of what is neither metal nor glass.", &T::specular);
  visit({.key = "anisotropy",
         .doc = "g of the Henyey-Greenstein phase function.",
         .range = inside(-1, 1),
         .absent = kAsLike},
        &T::anisotropy);
  share("surface_share", "Multiplies the share of the surface that follows from gradient and opacity.",
        &T::surface_share);
  share("transmission", "Share of rough glass among surface particles that are not metal.", &T::transmission);
  visit({.key = "ior", .doc = "Index of refraction of the glass.", .range = between(1, 4), .absent = "1.5"},
        &T::ior);
  share("diffuse_roughness", "Of the diffuse lobe: 0 is Lambert, 1 as flat as the moon.",
        &T::diffuse_roughness);
  visit({.key = "back_anisotropy",
         .doc = "g of a second lobe of the phase function.",
         .range = inside(-1, 1),
         .absent = kAsLike},
        &T::back_anisotropy);
  share("back_share", "Share of that lobe.", &T::back_share);
  visit({.key = "extinction_color",
         .doc = "Multiplies the extinction of each channel, where render.extinction is rgb.",
         .range = between(0, 1),
         .absent = "that of like, else the rules' or white"},
        &T::extinction_color);
}

inline StructInfo struct_info(Struct<IllustrationDescription>) {
  return {
      "Illustration",
      "A drawing in place of light transport: what a camera ray meets first has its albedo times the color "
      "of a ramp, by how much it faces a light, and contours. Lights, environment and shadows are not used."};
}
template <class V>
void visit_fields(V&& visit, Struct<IllustrationDescription>) {
  using T = IllustrationDescription;
  visit({.key = "ramp",
         .doc = "Colors by the cosine between normal and light, from -1 to 1; only value and color are used. "
                "Steps make a toon's flat tones. Empty is cool to warm.",
         .max_count = 256},
        &T::ramp);
  visit({.key = "direction",
         .doc = "From the scene to the light.",
         .unit = "LPS, or the camera's right, up, toward the eye",
         .is_direction = true},
        &T::direction);
  visit({.key = "attached_to", .doc = "What the direction is relative to."}, &T::attached_to);
  visit({.key = "contour", .doc = "How much contours replace the color.", .range = between(0, 1)},
        &T::contour);
  visit({.key = "contour_width",
         .doc = "Cosine between normal and view below which contours begin.",
         .range = between(0, 1)},
        &T::contour_width);
  visit({.key = "contour_color", .doc = "Of contours.", .range = at_least(0)}, &T::contour_color);
}

}  // namespace voxlume
