#pragma once
#include "scene/field_info.h"

namespace voxlume {

// Field tables (scene/field_table.h) of what changes from frame to frame.

inline StructInfo struct_info(Struct<AnimationTrack>) {
  return {"Track",
          "The course of one field. Before its first key and after its last one it stands still. Words and "
          "switches step; numbers, vectors and colors (in linear light) go from key to key; directions turn "
          "by the shortest way; transfer points go one by one where two lists have as many with the same "
          "keys, and else step."};
}
template <class V>
void visit_fields(V&& visit, Struct<AnimationTrack>) {
  using T = AnimationTrack;
  visit({.key = "field",
         .doc = "Address of a field of camera, lights, environment, background, clip, transfer, material or "
                "labels, such as \"/lights/0/intensity\", or \"/image/exposure_ev\".",
         .required = true},
        &T::field);
  visit({.key = "interpolation",
         .doc = "linear, smooth (starts and ends at rest, never beyond the keys) or step."},
        &T::interpolation);
  visit({.key = "keys",
         .doc = "Sorted by time; of two keys at one time the later holds from then on. A value is written as "
                "the field itself is.",
         .unit = "s",
         .range = between(-1e6, 1e6),
         .max_count = 65536,
         .required = true},
        &T::keys);
}

inline StructInfo struct_info(Struct<TurntableDescription>) {
  return {"Turntable",
          "The camera's way around its target, about the axis from feet to head. The last frame comes just "
          "before the first, so that the movie can be looped."};
}
template <class V>
void visit_fields(V&& visit, Struct<TurntableDescription>) {
  using T = TurntableDescription;
  visit({.key = "seconds", .doc = "Time of all turns.", .unit = "s", .range = between(1e-3, 1e6)},
        &T::seconds);
  visit({.key = "turns",
         .doc = "How often around; negative goes toward the patient's right.",
         .range = between(-50, 50)},
        &T::turns);
}

inline StructInfo struct_info(Struct<AnimationDescription>) {
  return {"Animation",
          "What changes from frame to frame. Frame k, counted from 0, shows the time k / fps and has random "
          "numbers of its own. See animation.md."};
}
template <class V>
void visit_fields(V&& visit, Struct<AnimationDescription>) {
  using T = AnimationDescription;
  visit({.key = "fps", .doc = "Frames a second.", .range = between(1e-3, 1000)}, &T::fps);
  visit({.key = "frames",
         .doc = "How many.",
         .range = between(1, 1e6),
         .absent = "the turntable's, else up to the last key and with it"},
        &T::frames);
  visit({.key = "turntable", .doc = "Once around.", .absent = "none"}, &T::turntable);
  visit({.key = "tracks", .doc = "What moves, and how.", .max_count = 1024}, &T::tracks);
}

}  // namespace voxlume
