#pragma once
#include <string>

namespace voxlume {

/// JSON Schema (draft 2020-12) of scene files, as text. docs/scene.schema.json holds a copy.
std::string scene_schema();

/// The reference of the scene file in Markdown. docs/scene-reference.md holds a copy.
std::string scene_reference_markdown();

}  // namespace voxlume
