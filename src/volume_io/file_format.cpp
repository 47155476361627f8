#include "volume_io/file_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "base/fail.h"

namespace voxlume {
namespace {

struct ExtensionRow {
  std::string_view extension;
  FileFormat format;
};

constexpr ExtensionRow kExtensions[] = {
    {".nrrd", FileFormat::kNrrd},     {".nhdr", FileFormat::kNrrd},   {".mha", FileFormat::kMetaImage},
    {".mhd", FileFormat::kMetaImage}, {".nii", FileFormat::kNifti},   {".nii.gz", FileFormat::kNifti},
    {".vtk", FileFormat::kVtk},       {".h5", FileFormat::kHdf5},     {".hdf5", FileFormat::kHdf5},
    {".tif", FileFormat::kTiff},      {".tiff", FileFormat::kTiff},   {".vdb", FileFormat::kVdb},
    {".dcm", FileFormat::kDicom},     {".dicom", FileFormat::kDicom}, {".ima", FileFormat::kDicom},
};

struct MagicRow {
  std::size_t offset;
  std::string_view bytes;
  FileFormat format;
};

using namespace std::string_view_literals;
constexpr MagicRow kMagics[] = {
    {128, "DICM"sv,
     FileFormat::kDicom},  // first: the 128 bytes before may look like another format on purpose
    {0, "NRRD0"sv, FileFormat::kNrrd},
    {0, "# vtk DataFile"sv, FileFormat::kVtk},
    {0, "\x89HDF\r\n\x1a\n"sv, FileFormat::kHdf5},
    {0, "II*\0"sv, FileFormat::kTiff},
    {0, "MM\0*"sv, FileFormat::kTiff},
    {0, "II+\0"sv, FileFormat::kTiff},
    {0, "MM\0+"sv, FileFormat::kTiff},
    {0, "\x20\x42\x44\x56\0\0\0\0"sv, FileFormat::kVdb},
    {344, "n+1\0"sv, FileFormat::kNifti},
    {0, "ObjectType"sv, FileFormat::kMetaImage},
    {0, "NDims"sv, FileFormat::kMetaImage},
};

}  // namespace

std::string_view format_name(FileFormat format) {
  constexpr std::string_view kNames[] = {"NRRD", "MetaImage", "NIfTI",   "legacy VTK",
                                         "HDF5", "TIFF",      "OpenVDB", "DICOM"};
  return kNames[static_cast<std::size_t>(format)];
}

std::string volume_extension(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  if (name.ends_with(".nii.gz")) return ".nii.gz";
  return std::filesystem::path(name).extension().string();
}

std::optional<FileFormat> format_of_extension(const std::filesystem::path& path) {
  const std::string extension = volume_extension(path);
  for (const ExtensionRow& row : kExtensions) {
    if (row.extension == extension) return row.format;
  }
  return std::nullopt;
}

std::optional<FileFormat> format_of_content(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    fail(ErrorCode::kFileNotFound, path,
         std::string("cannot open this file: ") + std::strerror(errno ? errno : EIO));
  }
  std::array<char, 512> start{};
  file.read(start.data(), start.size());
  const std::string_view bytes(start.data(), static_cast<std::size_t>(file.gcount()));
  if (bytes.empty()) fail(ErrorCode::kBadFormat, path, "the file is empty");
  for (const MagicRow& row : kMagics) {
    if (bytes.size() > row.offset && bytes.substr(row.offset).starts_with(row.bytes)) return row.format;
  }
  return std::nullopt;
}

std::string_view known_extensions() {
  return ".nrrd .nhdr .mha .mhd .nii .nii.gz .tif .tiff .vtk .h5 .hdf5 .vdb";
}

}  // namespace voxlume
