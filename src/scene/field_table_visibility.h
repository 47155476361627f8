#pragma once
#include "scene/field_info.h"

namespace voxlume {

// Field tables (scene/field_table.h) of what is important and how it is kept in view.

inline StructInfo struct_info(Struct<ImportanceDescription>) {
  return {
      "Importance",
      "What is important: points where all that is given holds, values of one or two volumes and a region."};
}
template <class V>
void visit_fields(V&& visit, Struct<ImportanceDescription>) {
  using T = ImportanceDescription;
  visit({.key = "importance", .doc = "Where several hold, the greatest counts.", .range = between(0, 1)},
        &T::importance);
  visit(
      {.key = "volume",
       .doc = "\"data\" or a proxy. For labels a proxy of kind distance with the range [0, 1e12], which has "
              "smooth borders."},
      &T::volume);
  visit({.key = "range", .doc = "Of the volume's values.", .absent = "all"}, &T::range);
  visit({.key = "along", .doc = "A second volume; with a proxy of kind gradient, value and gradient."},
        &T::along);
  visit({.key = "along_range", .doc = "Of the second volume's values.", .absent = "all"}, &T::along_range);
  visit({.key = "center_mm", .doc = "Middle of a region.", .unit = "mm, LPS", .absent = "everywhere"},
        &T::center_mm);
  visit({.key = "radius_mm",
         .doc = "Of a region that is a sphere.",
         .unit = "mm",
         .range = above_to(0, 1e9),
         .absent = "a box"},
        &T::radius_mm);
  visit({.key = "size_mm",
         .doc = "Edges of a region that is a box.",
         .unit = "mm",
         .range = above_to(0, 1e9),
         .absent = "a sphere"},
        &T::size_mm);
}

inline StructInfo struct_info(Struct<VisibilityDescription>) {
  return {"Visibility",
          "Matter before and behind what is important becomes transparent just enough: its extinction is "
          "multiplied by p / (p + (1 - importance)^(2 lambda) h), where h is q times what important lies "
          "behind it and r times what lies before it (docs/visibility.md)."};
}
template <class V>
void visit_fields(V&& visit, Struct<VisibilityDescription>) {
  using T = VisibilityDescription;
  visit({.key = "important", .doc = "What is important.", .max_count = 64}, &T::important);
  visit({.key = "p", .doc = "Weight of keeping matter as it is.", .range = between(1e-6, 1e6)}, &T::p);
  visit({.key = "q",
         .doc = "Weight of freeing the important from what is before it.",
         .unit = "1 / half the volume's longest side",
         .range = between(0, 1e6)},
        &T::q);
  visit({.key = "r",
         .doc = "Weight of freeing it from what is behind it.",
         .unit = "1 / half the volume's longest side",
         .range = between(0, 1e6)},
        &T::r);
  visit({.key = "lambda",
         .doc = "How much importance protects matter from fading; 0: not at all.",
         .range = between(0, 100)},
        &T::lambda);
  visit({.key = "lights",
         .doc = "Scatterings whose light rays are freed, too: none (off), the first of a path, or all."},
        &T::lights);
  visit({.key = "light_samples",
         .doc = "Looks for the important along a light ray.",
         .range = between(1, 4096)},
        &T::light_samples);
  visit({.key = "ray_samples", .doc = "Looks of a pass along the ray of a pixel.", .range = between(4, 4096)},
        &T::ray_samples);
  visit({.key = "ray_passes",
         .doc = "Passes before the first sample; three of four look where they find out most.",
         .range = between(1, 4096)},
        &T::ray_passes);
  visit({.key = "lookup",
         .doc = "Importance of interpolated values, or interpolated between that of voxels, as other methods "
                "do: as it is (per-voxel), or after a mean of 3 x 3 x 3 voxels (smoothed)."},
        &T::lookup);
  visit({.key = "sums",
         .doc = "Integrator ray-march: h by integrals, or by sums over the steps, which change with their "
                "length."},
        &T::sums);
}

}  // namespace voxlume
