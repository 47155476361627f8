#pragma once
#include "scene/field_info.h"

namespace voxlume {

// One table for each struct of voxlume/scene.h. visit_fields(visitor, Struct<T>{}) calls
// visitor(FieldInfo, &T::member) for every field, in the order in which files are written. A field that is
// not here does not exist in scene files.

/// Names the struct whose table is meant.
template <class T>
struct Struct {};

inline const WordChoices kAcceleratorWords{{"auto", "none", "macrocell"}, {"octree", "hierarchy", "residency"}};
inline const WordChoices kSimdWords{{"auto", "scalar"}, {"sse4", "avx2", "avx512"}};
inline const WordChoices kDenoiseWords{{"none"}, {"decoupled", "wrls", "svgf"}};
inline const WordChoices kLightSamplingWords{{"mis", "light", "direction"}, {}};
inline const WordChoices kAovWords{{"alpha", "depth", "normal", "albedo", "samples", "variance"}, {}};

/// Title and one paragraph of a struct, for the schema and the reference.
struct StructInfo {
  const char* name;
  const char* doc;
};

inline StructInfo struct_info(Struct<VolumeDescription>) { return {"Volume", "Where the voxels come from."}; }
template <class V>
void visit_fields(V&& visit, Struct<VolumeDescription>) {
  using T = VolumeDescription;
  visit({.key = "path", .doc = "File or DICOM folder; \"phantom\" is built in.", .is_path = true}, &T::path);
  visit({.key = "raw",
         .doc = "How to read a headerless file: \"WxHxD,type,sx,sy,sz[,little|big][,offset]\", type one of u8 i8 "
                "u16 i16 u32 i32 f32 f64. Empty for files with a header."},
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
         .doc = "Directions of the index axes: row-major 3x3, column a is the LPS direction of axis a; orthonormal.",
         .absent = "the file's"},
        &T::direction);
}

inline StructInfo struct_info(Struct<TransferPoint>) {
  return {"TransferPoint",
          "One control point. Every coefficient has its own piecewise-linear curve through the points that give "
          "it. A function uses opacity or mu_t_per_mm, not both."};
}
template <class V>
void visit_fields(V&& visit, Struct<TransferPoint>) {
  using T = TransferPoint;
  visit({.key = "value",
         .doc = "Data value in the file's own units (HU, intensity). Points are sorted by it; two at one value are "
                "a step.",
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
  visit({.key = "color",
         .doc = "Scattering albedo.",
         .range = between(0, 1),
         .absent = "the curve passes by"},
        &T::color);
  visit({.key = "emission",
         .doc = "Emitted radiance of an opaque region.",
         .range = at_least(0),
         .absent = "the curve passes by"},
        &T::emission);
}

inline StructInfo struct_info(Struct<TransferDescription>) {
  return {"Transfer", "Data value to optical coefficients: the data is interpolated first, then classified."};
}
template <class V>
void visit_fields(V&& visit, Struct<TransferDescription>) {
  using T = TransferDescription;
  visit({.key = "preset", .doc = "Name of a preset (`voxlume presets`); used where points is empty."}, &T::preset);
  visit({.key = "reference_length_mm",
         .doc = "Thickness an opacity refers to: mu_t = -ln(1 - min(opacity, 0.9999)) / reference_length_mm.",
         .unit = "mm",
         .range = above(0),
         .absent = "1 mm for CT, else longest side / 256"},
        &T::reference_length_mm);
  visit({.key = "density_scale", .doc = "Multiplies the extinction.", .range = between(0, 1e6)}, &T::density_scale);
  visit({.key = "points", .doc = "Control points, sorted by value.", .max_count = 65536}, &T::points);
}

inline StructInfo struct_info(Struct<LabelsDescription>) {
  return {"Labels",
          "Colors of a label volume over the transfer function's color, looked up without interpolation. The "
          "opacity is not changed."};
}
template <class V>
void visit_fields(V&& visit, Struct<LabelsDescription>) {
  using T = LabelsDescription;
  visit({.key = "path", .doc = "Label volume: any integer type, any grid.", .required = true, .is_path = true},
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
         .doc = "Surface and medium together (coexistence), one of the two by chance (er), or one alone."},
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
  visit({.key = "specular", .doc = "Fresnel F0 = 0.08 specular; 0 leaves a Lambert surface.", .range = between(0, 1)},
        &T::specular);
}

inline StructInfo struct_info(Struct<LightDescription>) { return {"Light", "A light other than the environment."}; }
template <class V>
void visit_fields(V&& visit, Struct<LightDescription>) {
  using T = LightDescription;
  visit({.key = "kind", .doc = "Shape of the light.", .required = true}, &T::kind);
  visit({.key = "attached_to",
         .doc = "What positions and directions are relative to. world: LPS mm. camera: (right, up, toward the eye) in "
                "mm from the camera's target, so that orbiting carries the light along."},
        &T::attached_to);
  visit({.key = "color", .doc = "Multiplies the intensity.", .range = at_least(0)}, &T::color);
  visit({.key = "intensity",
         .doc = "directional: irradiance on a plane facing it; point: radiant intensity; rect: radiance.",
         .range = at_least(0)},
        &T::intensity);
  visit({.key = "direction",
         .doc = "directional (required there, and only there): from the scene to the light; need not be a unit vector.",
         .absent = "none"},
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
  visit({.key = "up", .doc = "rect: direction of its height axis.", .absent = "the camera's or the world's up"},
        &T::up);
  visit({.key = "size_mm", .doc = "rect: width and height.", .unit = "mm", .range = above(0)}, &T::size_mm);
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
  visit({.key = "color", .doc = "Radiance, or what the picture is multiplied by.", .range = at_least(0)}, &T::color);
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
  visit({.key = "kind", .doc = "A color, the environment, or nothing (the picture gets an alpha channel).",
         .required = true},
        &T::kind);
  visit({.key = "color", .doc = "kind color: the radiance seen.", .range = at_least(0)}, &T::color);
}

inline StructInfo struct_info(Struct<CameraDescription>) {
  return {"Camera",
          "The eye: by angles around the target (0, 0 looks at the patient's face, head up), or by eye_mm, which "
          "overrides angles and zoom."};
}
template <class V>
void visit_fields(V&& visit, Struct<CameraDescription>) {
  using T = CameraDescription;
  constexpr NumberRange kAnyAngle = between(-36000, 36000);
  visit({.key = "projection", .doc = "How depth shows."}, &T::projection);
  visit({.key = "azimuth_deg", .doc = "Grows toward the patient's left.", .unit = "degrees", .range = kAnyAngle},
        &T::azimuth_deg);
  visit({.key = "elevation_deg", .doc = "Toward the head.", .unit = "degrees", .range = between(-90, 90)},
        &T::elevation_deg);
  visit({.key = "roll_deg",
         .doc = "Clockwise turn of the camera about its axis.",
         .unit = "degrees",
         .range = kAnyAngle},
        &T::roll_deg);
  visit({.key = "zoom", .doc = "1 fits the bounding sphere of what is visible.", .range = above_to(0, 1e6)},
        &T::zoom);
  visit({.key = "vertical_fov_deg",
         .doc = "perspective: vertical field of view.",
         .unit = "degrees",
         .range = above_to(0, 170)},
        &T::vertical_fov_deg);
  visit({.key = "target_mm",
         .doc = "The point looked at.",
         .unit = "mm",
         .absent = "the centre of what is visible"},
        &T::target_mm);
  visit({.key = "eye_mm", .doc = "Where the eye is.", .unit = "mm", .absent = "from the angles and zoom"}, &T::eye_mm);
  visit({.key = "up", .doc = "With eye_mm: the direction that is up in the picture.", .absent = "+z"}, &T::up);
  visit({.key = "height_mm",
         .doc = "orthographic: height of the view.",
         .unit = "mm",
         .range = above(0),
         .absent = "fits, divided by zoom"},
        &T::height_mm);
  visit({.key = "aperture_radius_mm",
         .doc = "Of a thin lens; 0 is a pinhole.",
         .unit = "mm",
         .range = at_least(0)},
        &T::aperture_radius_mm);
  visit({.key = "focus_mm",
         .doc = "Distance of the sharp plane from the eye.",
         .unit = "mm",
         .range = above(0),
         .absent = "the target's"},
        &T::focus_mm);
  visit({.key = "background_blur_deg",
         .doc = "Blur of the environment behind the volume: half angle of a large lens of its own.",
         .unit = "degrees",
         .range = between(0, 45)},
        &T::background_blur_deg);
}

inline StructInfo struct_info(Struct<ClipDescription>) {
  return {"Clip", "Keeps what is inside an axis-aligned box of LPS space."};
}
template <class V>
void visit_fields(V&& visit, Struct<ClipDescription>) {
  using T = ClipDescription;
  constexpr NumberRange kAnywhere = between(-1e30, 1e30);
  visit({.key = "x_mm", .doc = "Lower and upper end; +x is the patient's left.", .unit = "mm", .range = kAnywhere},
        &T::x_mm);
  visit({.key = "y_mm", .doc = "Lower and upper end; +y is posterior.", .unit = "mm", .range = kAnywhere}, &T::y_mm);
  visit({.key = "z_mm", .doc = "Lower and upper end; +z is the head.", .unit = "mm", .range = kAnywhere}, &T::z_mm);
  visit({.key = "blocks_light", .doc = "What is cut away still casts its shadow."}, &T::blocks_light);
}

inline StructInfo struct_info(Struct<ImageDescription>) {
  return {"Image",
          "The picture: its size, how long to work on it and how it is developed. Rendering stops at the first of "
          "spp, seconds and noise that is reached."};
}
template <class V>
void visit_fields(V&& visit, Struct<ImageDescription>) {
  using T = ImageDescription;
  visit({.key = "width", .doc = "Columns.", .unit = "pixels", .range = between(1, 65536)}, &T::width);
  visit({.key = "height", .doc = "Rows.", .unit = "pixels", .range = between(1, 65536)}, &T::height);
  visit({.key = "spp",
         .doc = "Stop after this many samples a pixel.",
         .range = between(1, 1e9),
         .absent = "the default picture's, where seconds and noise are absent too"},
        &T::spp);
  visit({.key = "seconds",
         .doc = "Stop after this time.",
         .unit = "s",
         .range = above_to(0, 1e9),
         .absent = "no limit"},
        &T::seconds);
  visit({.key = "noise",
         .doc = "Stop when the mean over pixels of standard error / (luminance + 0.01) is at most this.",
         .range = above_to(0, 1e6),
         .absent = "no limit"},
        &T::noise);
  visit({.key = "filter", .doc = "How samples spread over pixels."}, &T::filter);
  visit({.key = "filter_radius_px",
         .doc = "box: half width (0.5 is one pixel); gaussian: cut at this, sigma a third of it.",
         .unit = "pixels",
         .range = above_to(0, 8)},
        &T::filter_radius_px);
  visit({.key = "exposure_ev",
         .doc = "PNG: radiance is multiplied by 2^exposure_ev.",
         .unit = "EV",
         .range = between(-64, 64)},
        &T::exposure_ev);
  visit({.key = "tone_curve", .doc = "PNG: how radiance becomes display values."}, &T::tone_curve);
  visit({.key = "aovs",
         .doc = "Further layers of an EXR file.",
         .words = &kAovWords,
         .max_count = 16},
        &T::aovs);
}

inline StructInfo struct_info(Struct<RenderDescription>) { return {"Render", "How the light is computed."}; }
template <class V>
void visit_fields(V&& visit, Struct<RenderDescription>) {
  using T = RenderDescription;
  visit({.key = "seed",
         .doc = "Of the random numbers: the same seed gives the same picture.",
         .range = at_least(0)},
        &T::seed);
  visit({.key = "frame", .doc = "Number of the picture in an animation: other random numbers.",
         .range = at_least(0)},
        &T::frame);
  visit({.key = "max_scatter",
         .doc = "Most scatterings of a path; 0 is without limit, ended by Russian roulette.",
         .range = between(0, 1e6)},
        &T::max_scatter);
  visit({.key = "accelerator", .doc = "Structure of majorants.", .words = &kAcceleratorWords}, &T::accelerator);
  visit({.key = "macrocell_voxels",
         .doc = "Edge of a macrocell; 0 chooses.",
         .unit = "voxels",
         .range = between(0, 1024)},
        &T::macrocell_voxels);
  visit({.key = "simd", .doc = "Instruction set.", .words = &kSimdWords}, &T::simd);
  visit({.key = "denoise", .doc = "Denoiser.", .words = &kDenoiseWords}, &T::denoise);
  visit({.key = "light_sampling",
         .doc = "How light is gathered at a scattering: both techniques (mis), next-event estimation (light) or "
                "direction sampling alone, which never finds point and directional lights.",
         .words = &kLightSamplingWords},
        &T::light_sampling);
}

inline StructInfo struct_info(Struct<SceneDescription>) {
  return {"Scene",
          "Everything a picture is made from. Positions are LPS mm (x toward the patient's left, y toward "
          "posterior, z toward the head), extinction 1/mm, radiance linear Rec. 709. Relative paths start from "
          "the scene file's own folder."};
}
template <class V>
void visit_fields(V&& visit, Struct<SceneDescription>) {
  using T = SceneDescription;
  visit({.key = "version",
         .doc = "Version of the scene format.",
         .range = between(1, kSceneVersion),
         .required = true},
        &T::version);
  visit({.key = "volume", .doc = "Where the voxels come from."}, &T::volume);
  visit({.key = "transfer", .doc = "Data value to optical coefficients."}, &T::transfer);
  visit({.key = "labels", .doc = "Colors of a label volume.", .absent = "none"}, &T::labels);
  visit({.key = "material", .doc = "How matter scatters."}, &T::material);
  visit({.key = "lights", .doc = "Lights; [] is none.", .absent = "the default lights", .max_count = 256},
        &T::lights);
  visit({.key = "environment", .doc = "Light from everywhere.", .absent = "the default environment"},
        &T::environment);
  visit({.key = "background", .doc = "What is seen where the volume is not.", .absent = "the default background"},
        &T::background);
  visit({.key = "camera", .doc = "The eye."}, &T::camera);
  visit({.key = "clip", .doc = "Box of what is kept.", .absent = "everything"}, &T::clip);
  visit({.key = "image", .doc = "The picture."}, &T::image);
  visit({.key = "render", .doc = "How the light is computed."}, &T::render);
}

}  // namespace voxlume
