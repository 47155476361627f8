#pragma once
#include "scene/field_info.h"

namespace voxlume {

// Field tables (scene/field_table.h) of what is seen: volume, labels, material, clip box.

inline StructInfo struct_info(Struct<VolumeDescription>) { return {"Volume", "Where the voxels come from."}; }
template <class V>
void visit_fields(V&& visit, Struct<VolumeDescription>) {
  using T = VolumeDescription;
  visit({.key = "path", .doc = "File or DICOM folder; \"phantom\" is built in.", .is_path = true}, &T::path);
  visit({.key = "raw",
         .doc = "How to read a headerless file: \"WxHxD,type,sx,sy,sz[,little|big][,offset]\", type one of "
                "u8 i8 u16 i16 u32 i32 f32 f64. Empty for files with a header."},
        &T::raw);
  visit({.key = "spacing_mm",
         .doc = "Distance between voxel centres along the index axes.",
         .unit = "mm",
         .range = above_to(0, 1e6),
         .absent = "the file's"},
        &T::spacing_mm);
  visit({.key = "origin_mm",
         .doc = "Position of the first voxel's centre.",
         .unit = "mm, LPS",
         .absent = "the file's"},
        &T::origin_mm);
  visit({.key = "direction",
         .doc = "Directions of the index axes: row-major 3x3, column a is the LPS direction of axis a; "
                "orthonormal.",
         .absent = "the file's"},
        &T::direction);
}

inline StructInfo struct_info(Struct<LabelsDescription>) {
  return {"Labels",
          "Colors of a label volume over the transfer function's color, looked up without interpolation. The "
          "opacity is not changed."};
}
template <class V>
void visit_fields(V&& visit, Struct<LabelsDescription>) {
  using T = LabelsDescription;
  visit(
      {.key = "path", .doc = "Label volume: any integer type, any grid.", .required = true, .is_path = true},
      &T::path);
  visit({.key = "names",
         .doc = "Text file of label names and colors (.txt or .lut). Empty looks beside the label volume.",
         .is_path = true},
        &T::names);
  visit({.key = "strength",
         .doc = "How much of the label's color replaces the transfer function's.",
         .range = between(0, 1)},
        &T::strength);
}

inline StructInfo struct_info(Struct<MaterialDescription>) {
  return {"Material", "How matter scatters, beyond its albedo."};
}
template <class V>
void visit_fields(V&& visit, Struct<MaterialDescription>) {
  using T = MaterialDescription;
  visit({.key = "shading",
         .doc = "Surface and medium together (coexistence), one of the two by chance (er), one alone, or the "
                "phase function with highlights where the extinction changes (blinn-phong)."},
        &T::shading);
  visit({.key = "surface_share", .doc = "How the share of the surface follows from gradient and opacity."},
        &T::surface_share);
  visit({.key = "gradient_factor",
         .doc = "f of the surface share. hybrid: exponent 25 f^3; exponential: f itself.",
         .range = between(0, 1e3)},
        &T::gradient_factor);
  visit({.key = "opacity_modulated", .doc = "hybrid: multiply the surface share by the opacity."},
        &T::opacity_modulated);
  visit({.key = "anisotropy", .doc = "g of the Henyey-Greenstein phase function.", .range = inside(-1, 1)},
        &T::anisotropy);
  visit({.key = "roughness", .doc = "Of the surface lobe: GGX alpha = roughness^2.", .range = between(0, 1)},
        &T::roughness);
  visit({.key = "specular",
         .doc = "Fresnel F0 = 0.08 specular; 0 leaves a Lambert surface.",
         .range = between(0, 1)},
        &T::specular);
  visit({.key = "highlight",
         .doc = "Shading blinn-phong: strength of the highlights, times the change of the extinction over a "
                "voxel as a share of the greatest extinction.",
         .range = between(0, 1e3)},
        &T::highlight);
  visit({.key = "shininess",
         .doc = "Shading blinn-phong: exponent of the highlights.",
         .range = between(0, 1e4)},
        &T::shininess);
  visit({.key = "lobes",
         .doc =
             "What scatters: one BRDF that absorbs what its parts do not reflect (reciprocal), or normalized "
             "lobes whose absorption is all in the colors (particles). auto takes particles where "
             "materials or rules give more than opacities, colors and emission."},
        &T::lobes);
  visit(
      {.key = "self_occlusion",
       .doc = "Multiplies the extinction that shadow rays meet; below 1 brightens what shadows itself. 1 is "
              "physical.",
       .range = above_to(0, 1)},
      &T::self_occlusion);
}

inline StructInfo struct_info(Struct<ClipDescription>) {
  return {"Clip", "Keeps what is inside an axis-aligned box of LPS space."};
}
template <class V>
void visit_fields(V&& visit, Struct<ClipDescription>) {
  using T = ClipDescription;
  const auto side = [&](const char* key, const char* doc, std::array<double, 2> T::*member) {
    visit({.key = key, .doc = doc, .unit = "mm", .range = kAnyFace, .open_ended = true}, member);
  };
  side("x_mm", "Lower and upper end, null where it is open; +x is the patient's left.", &T::x_mm);
  side("y_mm", "Lower and upper end, null where it is open; +y is posterior.", &T::y_mm);
  side("z_mm", "Lower and upper end, null where it is open; +z is the head.", &T::z_mm);
  visit({.key = "blocks_light", .doc = "What is cut away still casts its shadow."}, &T::blocks_light);
}

}  // namespace voxlume
