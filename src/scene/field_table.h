#pragma once
#include "scene/field_info.h"
#include "scene/field_table_animation.h"
#include "scene/field_table_matter.h"
#include "scene/field_table_rules.h"
#include "scene/field_table_view.h"
#include "scene/field_table_visibility.h"

namespace voxlume {

// One table for each struct of voxlume/scene.h. visit_fields(visitor, Struct<T>{}) calls
// visitor(FieldInfo, &T::member) for every field, in the order in which files are written. A field that is
// not here does not exist in scene files.

inline const WordChoices kAcceleratorWords{{"auto", "none", "macrocell", "octree", "hierarchy", "residency"},
                                           {}};
inline const WordChoices kHierarchyRuleWords{{"cost", "thresholds"}, {}};
inline const WordChoices kSimdWords{{"auto", "scalar", "sse4", "avx2", "avx512", "neon"}, {}};
inline const WordChoices kDenoiseWords{{"none", "decoupled", "svgf", "asvgf", "atrous", "bilateral", "wrls",
                                        "rls", "wrls-no-feature", "rls-no-feature", "xu2024", "oidn"},
                                       {}};
inline const WordChoices kLightSamplingWords{{"mis", "light", "direction"}, {}};
inline const WordChoices kAovWords{{"alpha", "depth", "normal", "albedo", "samples", "variance", "denoise"},
                                   {}};

inline StructInfo struct_info(Struct<ImageDescription>) {
  return {"Image",
          "The picture: its size, how long to work on it and how it is developed. Rendering stops at the "
          "first of spp, seconds and noise that is reached."};
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
         .doc = "Stop after this time, once every pixel has a sample.",
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
  visit({.key = "aovs", .doc = "Further layers of an EXR file.", .words = &kAovWords, .max_count = 16},
        &T::aovs);
}

inline StructInfo struct_info(Struct<RenderDescription>) { return {"Render", "How the light is computed."}; }
template <class V>
void visit_fields(V&& visit, Struct<RenderDescription>) {
  using T = RenderDescription;
  visit(
      {.key = "integrator",
       .doc = "path: path tracing. As other renderers do, for comparison (docs/peers.md): exposure-render "
              "marches rays and scatters once, rmss also remembers where the environment is visible from, "
              "vpl-dvr adds virtual point lights, ar2t is path tracing with a material by opacity, ray-march "
              "adds up steps along rays that scatter once."},
      &T::integrator);
  visit({.key = "march_step_voxels",
         .doc = "Length of a step of the integrators that march.",
         .unit = "smallest voxel sides",
         .range = between(0.001, 100)},
        &T::march_step_voxels);
  visit(
      {.key = "march_jitter",
       .doc = "Integrator ray-march: rays begin anywhere in the first step; else in its middle, which leaves "
              "bands in place of noise."},
      &T::march_jitter);
  visit({.key = "virtual_lights",
         .doc = "Integrator vpl-dvr: light particles that are traced.",
         .range = between(1, 16384)},
        &T::virtual_lights);
  visit({.key = "virtual_light_radius",
         .doc = "Integrator vpl-dvr: virtual lights that are nearer count as this far, which keeps them from "
                "spots and loses light.",
         .unit = "radii of what is visible",
         .range = between(1e-4, 1)},
        &T::virtual_light_radius);
  visit({.key = "seed",
         .doc = "Of the random numbers: the same seed gives the same picture.",
         .range = at_least(0)},
        &T::seed);
  visit({.key = "frame",
         .doc = "Number of the picture in an animation: other random numbers.",
         .range = at_least(0)},
        &T::frame);
  visit({.key = "max_scatter",
         .doc = "Most scatterings of a path; 0 is without limit, ended by Russian roulette.",
         .range = between(0, 1e6)},
        &T::max_scatter);
  visit({.key = "accelerator",
         .doc = "Structure of majorants; auto is hierarchy. The picture stays the same.",
         .words = &kAcceleratorWords},
        &T::accelerator);
  visit({.key = "macrocell_voxels",
         .doc = "Edge of the finest cells; 0 chooses.",
         .unit = "voxels",
         .range = between(0, 1024)},
        &T::macrocell_voxels);
  visit(
      {.key = "hierarchy_rule",
       .doc = "What joins the hierarchy's cells to larger ones: the cost of crossing them (lookup_cost), or "
              "the thresholds of xu2025. The picture stays the same.",
       .words = &kHierarchyRuleWords},
      &T::hierarchy_rule);
  visit({.key = "lookup_cost",
         .doc = "Rule cost: what a look-up of the data costs, in crossings of a cell. Greater values make "
                "finer cells.",
         .range = between(0, 1000)},
        &T::lookup_cost);
  visit(
      {.key = "hierarchy_thresholds",
       .doc = "Rule thresholds: a walk leaves cells of fewer collisions than the first number for larger "
              "ones, and cells of more than the second for their parts. A cell counts as one of the finest.",
       .unit = "collisions over the edge of a finest cell",
       .range = between(0, 1e6)},
      &T::hierarchy_thresholds);
  visit({.key = "sampler",
         .doc = "The first random numbers of a pixel's samples: stratified against each other (sobol), which "
                "converges faster, or independent (random)."},
        &T::sampler);
  visit({.key = "light_samples",
         .doc =
             "Shadow rays at the first scattering of a path. More than one pays where several lights matter.",
         .range = between(1, 64)},
        &T::light_samples);
  visit({.key = "transmittance",
         .doc = "How shadow rays are estimated: ratio tracking, residual ratio tracking or unbiased ray "
                "marching. All have the same mean. All but ratio take the macrocell accelerator and scalar "
                "code."},
        &T::transmittance);
  visit({.key = "free_flight",
         .doc = "How collisions are found: delta tracking, or decomposition tracking, which takes the "
                "macrocell accelerator and scalar code. Both have the same distribution."},
        &T::free_flight);
  visit(
      {.key = "extinction",
       .doc = "single: one extinction for all channels. rgb: every channel has its own, the extinction times "
              "the extinction_color of points and materials; takes scalar code, transmittance ratio and "
              "free_flight delta (docs/rgb-extinction.md)."},
      &T::extinction);
  visit({.key = "shadow_roulette",
         .doc = "A shadow ray that can add less than this many times what the path's first one could is cast "
                "by Russian roulette; 0 casts all.",
         .range = between(0, 100)},
        &T::shadow_roulette);
  visit({.key = "simd", .doc = "Instruction set.", .words = &kSimdWords}, &T::simd);
  visit({.key = "denoise",
         .doc = "Takes noise out of the finished picture (docs/denoising.md).",
         .words = &kDenoiseWords},
        &T::denoise);
  visit({.key = "light_sampling",
         .doc = "How light is gathered at a scattering: both techniques (mis), next-event estimation (light) "
                "or direction sampling alone, which never finds point and directional lights.",
         .words = &kLightSamplingWords},
        &T::light_sampling);
}

inline StructInfo struct_info(Struct<SceneDescription>) {
  return {"Scene",
          "Everything a picture is made from. Positions are LPS mm (x toward the patient's left, y toward "
          "posterior, z toward the head), extinction 1/mm, radiance linear Rec. 709. Relative paths start "
          "from the scene file's own folder."};
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
  visit({.key = "proxies", .doc = "Further volumes, for rules.", .max_count = 3}, &T::proxies);
  visit({.key = "transfer", .doc = "Data value to optical coefficients."}, &T::transfer);
  visit({.key = "labels", .doc = "Colors of a label volume.", .absent = "none"}, &T::labels);
  visit({.key = "material", .doc = "How matter scatters."}, &T::material);
  visit({.key = "materials", .doc = "Materials that rules name, beside the library's.", .max_count = 1024},
        &T::materials);
  visit({.key = "illustration",
         .doc = "Toon or warm-cool shading with contours, in place of light.",
         .absent = "light transport"},
        &T::illustration);
  visit({.key = "visibility",
         .doc = "What is important is kept in view.",
         .absent = "matter is as opaque as it is"},
        &T::visibility);
  visit({.key = "lights", .doc = "Lights; [] is none.", .absent = "the default lights", .max_count = 256},
        &T::lights);
  visit({.key = "environment", .doc = "Light from everywhere.", .absent = "the default environment"},
        &T::environment);
  visit({.key = "background",
         .doc = "What is seen where the volume is not.",
         .absent = "the default background"},
        &T::background);
  visit({.key = "camera", .doc = "The eye."}, &T::camera);
  visit({.key = "clip", .doc = "Box of what is kept.", .absent = "everything"}, &T::clip);
  visit({.key = "image", .doc = "The picture."}, &T::image);
  visit({.key = "render", .doc = "How the light is computed."}, &T::render);
  visit({.key = "animation", .doc = "What changes from frame to frame.", .absent = "a still picture"},
        &T::animation);
}

}  // namespace voxlume
