#pragma once
#include <filesystem>
#include <optional>
#include <string_view>

namespace voxlume {

enum class FileFormat { kNrrd, kMetaImage, kNifti, kVtk, kHdf5, kTiff, kVdb, kDicom };

/// "NRRD", "MetaImage", ...: what Volume::format and messages say.
std::string_view format_name(FileFormat format);

/// By the extension, in any case. ".nii.gz" counts, ".gz" alone does not.
std::optional<FileFormat> format_of_extension(const std::filesystem::path& path);

/// By the first bytes of the file; none when they are not known.
/// Throws Error kFileNotFound when the file cannot be opened, kBadFormat when it is empty.
std::optional<FileFormat> format_of_content(const std::filesystem::path& path);

/// ".nrrd .nhdr ...": every extension voxlume reads and writes, for messages.
std::string_view known_extensions();

/// The extension in lower case, ".nii.gz" as one.
std::string volume_extension(const std::filesystem::path& path);

}  // namespace voxlume
