#include <fmt/format.h>
#include <itkVTKImageIO.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <sstream>
#include <string>

#include "base/fail.h"
#include "volume_io/file_format.h"
#include "volume_io/itk_header.h"
#include "volume_io/itk_read.h"
#include "volume_io/voxel_stream.h"

namespace voxlume {
namespace {

struct VtkData {
  std::uint64_t offset_bytes = 0;
  bool binary = false;
};

/// ITK takes "DIMENSIONS 9 8 0" for a flat image.
void check_dimensions_line(const std::filesystem::path& path, const std::string& line) {
  std::istringstream words(line);
  std::string word;
  std::int64_t n[3] = {};
  words >> word >> n[0] >> n[1] >> n[2];
  if (!words || n[0] < 1 || n[1] < 1 || n[2] < 1) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("\"{}\"; expected three whole numbers above 0", one_line(line)));
  }
}

/// Where the numbers of the first SCALARS array begin, and whether they are binary.
VtkData find_vtk_data(const std::filesystem::path& path) {
  constexpr int kMaxHeaderLines = 64;
  std::ifstream file(path, std::ios::binary);
  VtkData data;
  std::string line;
  for (int i = 0; i < kMaxHeaderLines && std::getline(file, line); ++i) {
    std::transform(line.begin(), line.end(), line.begin(), [](unsigned char c) { return std::tolower(c); });
    if (i == 2) data.binary = line.starts_with("binary");
    if (line.starts_with("dataset") && line.find("structured_points") == std::string::npos) {
      fail(ErrorCode::kUnsupported, path,
           fmt::format("\"{}\"; expected DATASET STRUCTURED_POINTS", one_line(line)));
    }
    if (line.starts_with("dimensions")) check_dimensions_line(path, line);
    if (!line.starts_with("scalars")) continue;
    data.offset_bytes = static_cast<std::uint64_t>(file.tellg());
    if (std::getline(file, line) && (line.starts_with("LOOKUP_TABLE") || line.starts_with("lookup_table"))) {
      data.offset_bytes = static_cast<std::uint64_t>(file.tellg());
    }
    return data;
  }
  fail(ErrorCode::kBadFormat, path, "no SCALARS line in the header; expected structured points with scalars");
}

class VtkReader : public VolumeReader {
 public:
  explicit VtkReader(const std::filesystem::path& path) : path_(path) {}

  VolumeHeader read_header(const Progress&) override {
    data_ = find_vtk_data(path_);
    VolumeHeader header = read_itk_header(*itk::VTKImageIO::New(), path_);
    header.volume.format = format_name(FileFormat::kVtk);
    count_ = header.volume.voxel_count();
    value_bytes_ = header.stored_bytes() / std::max<std::uint64_t>(count_, 1);
    type_ = header.volume.type;
    const std::uint64_t file_bytes = std::filesystem::file_size(path_);
    const std::uint64_t data_bytes = file_bytes - std::min(data_.offset_bytes, file_bytes);
    // A number written as text takes at least two bytes, the last may take one.
    const std::uint64_t least = data_.binary ? header.stored_bytes() : 2 * count_ - 1;
    if (data_bytes < least) {
      fail(ErrorCode::kBadFormat, path_,
           fmt::format("expected at least {} bytes of voxels, file has {}", least, data_bytes));
    }
    if (!data_.binary && header.wide != WideInteger::kNone) {
      fail(ErrorCode::kUnsupported, path_, "64-bit integers written as text; write them as binary first");
    }
    return header;
  }

  void read_voxels(void* voxels, const Progress& progress) override {
    if (!data_.binary) return read_text(path_, data_.offset_bytes, type_, voxels, count_, progress);
    read_plain(path_, data_.offset_bytes, voxels, count_ * value_bytes_, progress);
    swap_bytes(voxels, count_, value_bytes_);  // binary legacy VTK is big-endian
  }

 private:
  std::filesystem::path path_;
  VtkData data_;
  std::uint64_t count_ = 0;
  std::size_t value_bytes_ = 1;
  VoxelType type_ = VoxelType::kU8;
};

}  // namespace

std::unique_ptr<VolumeReader> make_vtk_reader(const std::filesystem::path& path) {
  return std::make_unique<VtkReader>(path);
}

}  // namespace voxlume
