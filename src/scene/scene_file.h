#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "voxlume/scene.h"

namespace voxlume {

/// Scene text of more bytes than this is refused.
constexpr std::size_t kMaxSceneBytes = std::size_t{64} << 20;

/// Reads a scene from JSON text and checks it (validate_scene). Paths stay as written. `where` names the text
/// in messages, usually its file. Throws Error: kBadFormat (not JSON; "scene.json: line 3, column 7: ..."),
/// kBadParameter ("scene.json: /transfer/points/3: unknown key ...") or kUnsupported.
SceneDescription parse_scene(std::string_view json, const std::string& where);

/// Reads a scene file. Relative paths in it start from the file's own folder: they come back joined to it
/// (and absolute, if `path` is). Throws Error: kFileNotFound, and those of parse_scene.
SceneDescription read_scene(const std::filesystem::path& path);

/// A scene as JSON text ending in a line break; parse_scene gives back an equal description. Writes only what
/// differs from the default, or with `all_fields` everything but absent optionals. Keys are in table order.
/// Throws Error kBadParameter where a text is not UTF-8.
std::string write_scene(const SceneDescription& scene, bool all_fields = false);

/// Writes a scene file, aside and then renamed. Paths inside the file's folder are written relative to it,
/// all others absolute, so that the scene can be read from anywhere. Throws Error: kInternal when the disk
/// fails.
void save_scene(const SceneDescription& scene, const std::filesystem::path& path, bool all_fields = false);

/// Sets one field from text, as a command line gives it: `address` is the field's JSON pointer
/// ("/image/spp", "/lights/0/intensity"); numbers, words, "#rrggbb", and comma-separated lists are read as
/// such, objects as JSON. Absent structs on the way are created. Checks the field's own range; rules between
/// fields are left to validate_scene. Throws Error at `where` (say, the flag).
void set_scene_field(SceneDescription& scene, std::string_view address, std::string_view text,
                     const std::string& where);

/// What the field at `address` means, with its range and unit, as the reference says it. Throws Error
/// kBadParameter for an address that is none.
std::string describe_scene_field(std::string_view address);

/// Calls `change` for every non-empty path of the scene that names a file (so not for the built-in
/// "phantom").
void for_each_path(SceneDescription& scene, const std::function<void(std::string& path)>& change);

/// The built-in volume's name in place of a path.
constexpr std::string_view kPhantomPath = "phantom";

}  // namespace voxlume
