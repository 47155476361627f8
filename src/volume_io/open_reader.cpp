#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/fail.h"
#include "volume_io/dicom_series.h"
#include "volume_io/file_format.h"
#include "volume_io/itk_read.h"
#include "volume_io/natural_order.h"
#include "volume_io/nifti_read.h"
#include "volume_io/staged_read.h"
#include "volume_io/tiff_read.h"
#include "volume_io/vdb_read.h"
#include "volume_io/volume_reader.h"

namespace voxlume {
namespace {

/// The regular files of a folder without the hidden ones, in natural order of their names.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.is_regular_file(error) && !entry.path().filename().string().starts_with("."))
      files.push_back(entry.path());
  }
  if (error) fail(ErrorCode::kFileNotFound, folder, "cannot list this folder: " + error.message());
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
    return natural_less(a.filename().string(), b.filename().string());
  });
  return files;
}

std::unique_ptr<VolumeReader> open_folder(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> tiffs;
  std::vector<std::filesystem::path> others;
  for (const std::filesystem::path& file : files_of(folder)) {
    const auto format = format_of_extension(file);
    if (format == FileFormat::kTiff) tiffs.push_back(file);
    // DICOM files often have no extension, or a number for one.
    if (!format || format == FileFormat::kDicom) others.push_back(file);
  }
  if (tiffs.empty() && others.empty()) {
    fail(ErrorCode::kBadFormat, folder,
         "no DICOM or TIFF files in this folder; expected a DICOM series or TIFF slices");
  }
  if (others.empty()) return make_tiff_reader(tiffs);
  return tiffs.empty() || has_dicom(others) ? make_dicom_reader(folder, others) : make_tiff_reader(tiffs);
}

FileFormat format_of_file(const std::filesystem::path& path) {
  const auto by_content = format_of_content(path);
  const auto by_name = format_of_extension(path);
  if (by_name && by_content && *by_name != *by_content) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("the name says {}, the content is {}", format_name(*by_name), format_name(*by_content)));
  }
  if (by_name) return *by_name;
  if (by_content) return *by_content;
  fail(ErrorCode::kUnsupported, path,
       fmt::format(
           "not a known volume format; expected one of {}, or a DICOM folder; raw voxels need a header "
           "(.nhdr, .mhd), or --raw on the command line",
           known_extensions()));
}

}  // namespace

std::unique_ptr<VolumeReader> open_reader(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) return open_folder(path);
  if (!std::filesystem::is_regular_file(path)) {
    fail(ErrorCode::kBadFormat, path, "neither a file nor a folder; expected a volume file");
  }
  switch (format_of_file(path)) {
    case FileFormat::kMetaImage:
      return make_meta_reader(path);
    case FileFormat::kNifti:
      return make_nifti_reader(path);
    case FileFormat::kVtk:
      return make_vtk_reader(path);
    case FileFormat::kTiff:
      return make_tiff_reader({path});
    case FileFormat::kVdb:
      return make_vdb_reader(path);
    case FileFormat::kDicom:
      return make_dicom_reader(path, {path});
    case FileFormat::kHdf5:
      return make_hdf5_reader(path);
    default:
      return make_nrrd_reader(path);
  }
}

std::string reader_name(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return "DICOM or TIFF folders";
  const auto format = format_of_extension(path);
  return format ? std::string(format_name(*format)) : "this format";
}

}  // namespace voxlume
