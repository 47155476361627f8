#pragma once
#include <string>

#include "voxlume/scene.h"

namespace voxlume {

/// Checks everything a description can be checked for without its volume: number ranges, vocabularies, list
/// lengths, and rules between fields (sorted points, opacity or extinction, what each kind of light needs).
/// `where` starts the address in messages: "scene.json: /". Throws Error: kBadParameter, or kUnsupported for
/// a word that is known and not built yet.
void validate_scene(const SceneDescription& scene, const std::string& where = "/");

}  // namespace voxlume
