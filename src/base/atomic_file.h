#pragma once
#include <filesystem>
#include <functional>
#include <string_view>

namespace voxlume {

/// Writes a file so that readers see the old one or the whole new one, never a part: `write` is called once
/// with the name of a temporary file in the same folder, which then takes the place of `path` and keeps its
/// permissions. A symbolic link is followed; a device or pipe is written in place. When `write` throws, the
/// temporary file is removed, `path` is untouched and the exception goes on.
/// Throws Error: kFileNotFound when the folder does not exist, kBadParameter when `path` is a folder,
/// kInternal when the file cannot be put in place.
void write_file_atomically(const std::filesystem::path& path,
                           const std::function<void(const std::filesystem::path& temporary)>& write);

/// The same, for bytes at hand. Throws Error kInternal also when they cannot be written.
void write_file_atomically(const std::filesystem::path& path, std::string_view bytes);

}  // namespace voxlume
