#include <fmt/format.h>

#include <cstdlib>
#include <fstream>
#include <mutex>
#include <shared_mutex>
#include <vector>

#include "base/fail.h"
#include "volume_io/file_format.h"
#include "volume_io/geometry_check.h"
#include "volume_io/isolated_read.h"
#include "volume_io/library_message.h"
#include "volume_io/reorient.h"
#include "volume_io/volume_writers.h"
#include "voxlume/volume_io.h"

namespace voxlume {
namespace {

/// A new hidden folder beside the result, removed with what is left in it.
class AsideFolder {
 public:
  explicit AsideFolder(const std::filesystem::path& beside) {
    std::string name = (beside / ".voxlume-XXXXXX").string();
    if (!mkdtemp(name.data())) {
      fail(ErrorCode::kInternal, beside, "cannot write into this folder (missing, full or not writable)");
    }
    path_ = name;
  }
  ~AsideFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  AsideFolder(const AsideFolder&) = delete;
  AsideFolder& operator=(const AsideFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::filesystem::path folder_of(const std::filesystem::path& path) {
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

void move_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::error_code error;
  std::filesystem::rename(from, to, error);
  if (error) fail(ErrorCode::kInternal, to, "cannot be put in place: " + error.message());
}

std::uint32_t last_word(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  file.seekg(-4, std::ios::end);
  unsigned char b[4] = {};
  file.read(reinterpret_cast<char*>(b), 4);
  return static_cast<std::uint32_t>(b[0] | (b[1] << 8) | (b[2] << 16)) |
         (static_cast<std::uint32_t>(b[3]) << 24);
}

/// The libraries do not all report a full disk: looks whether the voxels can be there.
void check_written(const Volume& volume, const std::vector<std::filesystem::path>& files,
                   const std::filesystem::path& path) {
  constexpr std::uint32_t kNiftiVoxelOffset = 352;
  std::uint64_t total = 0;
  for (const std::filesystem::path& file : files) total += std::filesystem::file_size(file);
  const std::string extension = volume_extension(path);
  const auto gzip_length = static_cast<std::uint32_t>(volume.byte_count());  // gzip keeps it modulo 2^32
  bool whole = total >= volume.byte_count();
  if (extension == ".nrrd") whole = total > 64 && last_word(files[0]) == gzip_length;
  if (extension == ".nii.gz") whole = total > 64 && last_word(files[0]) == gzip_length + kNiftiVoxelOffset;
  if (extension == ".vdb" || extension == ".h5" || extension == ".hdf5")
    whole = total > 0;  // these libraries throw
  if (!whole) fail(ErrorCode::kInternal, path, "not everything could be written (disk full?)");
}

/// x.nhdr and x.mhd both keep their voxels in x.raw: writing one must not change what the other points to.
void check_data_name_free(const std::filesystem::path& path) {
  const std::string extension = volume_extension(path);
  if (extension != ".nhdr" && extension != ".mhd") return;
  std::filesystem::path other = path;
  other.replace_extension(extension == ".nhdr" ? ".mhd" : ".nhdr");
  if (!std::filesystem::exists(other)) return;
  fail(ErrorCode::kBadParameter, path,
       fmt::format("its voxels would overwrite those of \"{}\"; expected another name",
                   other.filename().string()));
}

/// Moves a written volume into place, its header last: a header found there always belongs to the data beside
/// it.
void put_in_place(const std::vector<std::filesystem::path>& files, const std::filesystem::path& path) {
  const bool detached = files.size() > 1;
  if (detached) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
  for (const std::filesystem::path& file : files) {
    if (file.filename() != path.filename()) move_file(file, folder_of(path) / file.filename());
  }
  for (const std::filesystem::path& file : files) {
    if (file.filename() == path.filename()) move_file(file, path);
  }
}

void write_file(const Volume& volume, const std::filesystem::path& path, FileFormat format) {
  check_data_name_free(path);
  const AsideFolder aside(folder_of(path));
  const std::filesystem::path target = aside.path() / path.filename();
  switch (format) {
    case FileFormat::kTiff:
      write_tiff(volume, target);
      break;
    case FileFormat::kVdb:
      write_vdb(volume, target);
      break;
    default:
      write_itk(volume, target, format);
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(aside.path())) files.push_back(entry.path());
  if (files.empty()) fail(ErrorCode::kInternal, path, "nothing was written");
  check_written(volume, files, path);
  put_in_place(files, path);
}

void write_folder(const Volume& volume, std::filesystem::path path) {
  if (!path.has_filename()) path = path.parent_path();
  if (std::filesystem::exists(path) && !std::filesystem::is_empty(path)) {
    fail(ErrorCode::kBadParameter, path,
         "the folder is not empty; expected an empty or new one for a DICOM series");
  }
  const AsideFolder aside(folder_of(path));
  const std::filesystem::path target = aside.path() / "series";
  write_dicom(volume, target);
  move_file(target, path);
}

void write_checked(const Volume& volume, const std::filesystem::path& path) {
  if (!volume.voxels) fail(ErrorCode::kBadParameter, path, "a volume without voxels cannot be written");
  Volume checked = volume;
  check_geometry(path, checked);
  // A fork must not happen while the libraries hold their locks.
  const std::shared_lock lock(library_mutex());
  if (!path.has_filename() || std::filesystem::is_directory(path)) return write_folder(checked, path);
  const auto format = format_of_extension(path);
  if (!format || *format == FileFormat::kDicom) {
    fail(ErrorCode::kUnsupported, path,
         fmt::format("cannot write \"{}\"; expected one of {}, or a folder (ending in /) for a DICOM series",
                     volume_extension(path), known_extensions()));
  }
  const bool carries_orientation = *format != FileFormat::kTiff && *format != FileFormat::kVtk;
  write_file(carries_orientation ? checked : along_lps_axes(path, checked), path, *format);
}

}  // namespace

void write_volume(const Volume& volume, const std::filesystem::path& path) {
  try {
    write_checked(volume, path);
  } catch (const std::filesystem::filesystem_error& error) {
    fail(ErrorCode::kInternal, path, "cannot be written: " + error.code().message());
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    fail(ErrorCode::kInternal, path, "cannot be written: " + library_message(error.what()));
  }
}

}  // namespace voxlume
