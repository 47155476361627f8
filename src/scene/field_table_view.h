#pragma once
#include "scene/field_info.h"

namespace voxlume {

// Field tables (scene/field_table.h) of what it is seen by: lights, environment, background, camera.

/// Lengths whose squares, and their inverses, are finite in single precision [mm].
constexpr NumberRange kLength = between(1e-6, 1e9);

inline StructInfo struct_info(Struct<LightDescription>) {
  return {"Light", "A light other than the environment."};
}
template <class V>
void visit_fields(V&& visit, Struct<LightDescription>) {
  using T = LightDescription;
  visit({.key = "kind", .doc = "Shape of the light.", .required = true}, &T::kind);
  visit({.key = "attached_to",
         .doc = "What positions and directions are relative to. world: LPS mm. camera: (right, up, toward "
                "the eye) in mm from the camera's target, so that orbiting carries the light along."},
        &T::attached_to);
  visit({.key = "color", .doc = "Multiplies the intensity.", .range = at_least(0)}, &T::color);
  visit({.key = "intensity",
         .doc = "directional: irradiance on a plane facing it; point: radiant intensity; rect: radiance.",
         .range = at_least(0)},
        &T::intensity);
  visit({.key = "direction",
         .doc = "directional (required there, and only there): from the scene to the light; need not be a "
                "unit vector.",
         .absent = "none",
         .is_direction = true},
        &T::direction);
  visit({.key = "position_mm",
         .doc = "point and rect (required there, and only there): where it is; a rectangle's centre.",
         .unit = "mm",
         .absent = "none"},
        &T::position_mm);
  visit({.key = "target_mm",
         .doc = "rect: the point its front faces.",
         .unit = "mm",
         .absent = "the camera's target"},
        &T::target_mm);
  visit({.key = "up",
         .doc = "rect: direction of its height axis.",
         .absent = "the camera's or the world's up",
         .is_direction = true},
        &T::up);
  visit({.key = "size_mm", .doc = "rect: width and height.", .unit = "mm", .range = kLength}, &T::size_mm);
  visit({.key = "two_sided", .doc = "rect: emits from its back as well."}, &T::two_sided);
}

inline StructInfo struct_info(Struct<EnvironmentDescription>) {
  return {"Environment", "Light from everywhere: a color, or an equirectangular picture times that color."};
}
template <class V>
void visit_fields(V&& visit, Struct<EnvironmentDescription>) {
  using T = EnvironmentDescription;
  visit({.key = "image",
         .doc = "EXR or HDR picture, width = 2 height, +z (head) at its top. Empty is constant.",
         .is_path = true},
        &T::image);
  visit({.key = "color", .doc = "Radiance, or what the picture is multiplied by.", .range = at_least(0)},
        &T::color);
  visit({.key = "intensity", .doc = "Scale of the radiance.", .range = at_least(0)}, &T::intensity);
  visit({.key = "rotation_deg",
         .doc = "Turn about +z, toward the patient's left.",
         .unit = "degrees",
         .range = between(-36000, 36000)},
        &T::rotation_deg);
  visit({.key = "attached_to", .doc = "Whether it stands still or turns with the camera."}, &T::attached_to);
  visit({.key = "ambient",
         .doc = "Adds albedo times the mean radiance to every scattering, unshadowed. Not physical."},
        &T::ambient);
}

inline StructInfo struct_info(Struct<BackgroundDescription>) {
  return {"Background", "What is seen where the volume is not."};
}
template <class V>
void visit_fields(V&& visit, Struct<BackgroundDescription>) {
  using T = BackgroundDescription;
  visit({.key = "kind",
         .doc = "A color, the environment, or nothing (the picture gets an alpha channel).",
         .required = true},
        &T::kind);
  visit({.key = "color", .doc = "kind color: the radiance seen.", .range = at_least(0)}, &T::color);
}

inline StructInfo struct_info(Struct<CameraDescription>) {
  return {"Camera",
          "The eye: by angles around the target (0, 0 looks at the patient's face, head up), or by eye_mm, "
          "which overrides angles and zoom."};
}
template <class V>
void visit_fields(V&& visit, Struct<CameraDescription>) {
  using T = CameraDescription;
  constexpr NumberRange kAnyAngle = between(-36000, 36000);
  visit({.key = "projection", .doc = "How depth shows."}, &T::projection);
  visit({.key = "azimuth_deg",
         .doc = "Grows toward the patient's left.",
         .unit = "degrees",
         .range = kAnyAngle},
        &T::azimuth_deg);
  visit({.key = "elevation_deg", .doc = "Toward the head.", .unit = "degrees", .range = between(-90, 90)},
        &T::elevation_deg);
  visit({.key = "roll_deg",
         .doc = "Clockwise turn of the camera about its axis.",
         .unit = "degrees",
         .range = kAnyAngle},
        &T::roll_deg);
  visit({.key = "zoom",
         .doc = "1 fits the bounding sphere of the volume, or of the part that the clip box keeps.",
         .range = between(1e-6, 1e6)},
        &T::zoom);
  visit({.key = "vertical_fov_deg",
         .doc = "perspective: vertical field of view.",
         .unit = "degrees",
         .range = between(1e-3, 170)},
        &T::vertical_fov_deg);
  visit({.key = "target_mm",
         .doc = "The point looked at.",
         .unit = "mm",
         .absent = "the centre of what is visible"},
        &T::target_mm);
  visit({.key = "eye_mm", .doc = "Where the eye is.", .unit = "mm", .absent = "from the angles and zoom"},
        &T::eye_mm);
  visit({.key = "up",
         .doc = "With eye_mm: the direction that is up in the picture.",
         .absent = "+z",
         .is_direction = true},
        &T::up);
  visit({.key = "height_mm",
         .doc = "orthographic: height of the view.",
         .unit = "mm",
         .range = kLength,
         .absent = "fits, divided by zoom"},
        &T::height_mm);
  visit({.key = "aperture_radius_mm",
         .doc = "Of a thin lens; 0 is a pinhole.",
         .unit = "mm",
         .range = between(0, 1e9)},
        &T::aperture_radius_mm);
  visit({.key = "focus_mm",
         .doc = "Distance of the sharp plane from the eye.",
         .unit = "mm",
         .range = kLength,
         .absent = "the target's"},
        &T::focus_mm);
  visit({.key = "background_blur_deg",
         .doc = "Blur of the environment behind the volume: half angle of a large lens of its own.",
         .unit = "degrees",
         .range = between(0, 45)},
        &T::background_blur_deg);
  visit({.key = "fit_radius_mm",
         .doc = "Radius of the sphere around the target that zoom 1 fits.",
         .unit = "mm",
         .range = kLength,
         .absent = "that of what is visible"},
        &T::fit_radius_mm);
}

}  // namespace voxlume
