#pragma once
#include <string>

#include "voxlume/scene.h"

namespace voxlume {

/// Checks everything an animation can be checked for without its scene's values: fields that exist and can
/// change, sorted times, and for every key the type and range of its field. `where` starts the address in
/// messages. Throws Error kBadParameter.
void check_animation(const AnimationDescription& animation, const std::string& where);

/// How many frames there are, >= 1. Throws Error kBadParameter at "/animation" when nothing says how many, or
/// there are more than a million.
int frame_count(const AnimationDescription& animation);

/// The scene at a time [s], without its animation. A pure function, in double precision. `animated` is valid
/// (validate_scene). Lists are as long as
/// in `animated`, so lights and transfer points that tracks name by index must be there: resolve the scene
/// first (then what nothing moves stays as it is, the camera's framing above all), and again afterwards if a
/// track chooses presets. Validates what comes out. Throws Error kBadParameter for values that do not go
/// together at that time.
SceneDescription scene_at(const SceneDescription& animated, double time_s);

/// When frame `frame`, counted from 0, is [s].
double frame_time_s(const AnimationDescription& animation, int frame);

/// scene_at() the time of a frame, with the frame's own random numbers: render.frame is moved on by `frame`.
/// Errors name the frame. `animated` has an animation.
SceneDescription scene_of_frame(const SceneDescription& animated, int frame);

}  // namespace voxlume
