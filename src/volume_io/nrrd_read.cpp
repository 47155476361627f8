#include <fmt/format.h>
#include <itkNrrdImageIO.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "base/fail.h"
#include "volume_io/file_format.h"
#include "volume_io/itk_header.h"
#include "volume_io/itk_read.h"
#include "volume_io/nrrd_fields.h"
#include "volume_io/nrrd_space.h"
#include "volume_io/voxel_stream.h"

namespace voxlume {
namespace {

class NrrdReader : public VolumeReader {
 public:
  explicit NrrdReader(const std::filesystem::path& path) : path_(path), io_(itk::NrrdImageIO::New()) {}

  VolumeHeader read_header() override {
    VolumeHeader header = read_itk_header(*io_, path_);
    header.volume.format = format_name(FileFormat::kNrrd);
    fields_ = read_nrrd_fields(path_);
    check_sizes();
    complete_nrrd_space(path_, fields_, header.volume);
    count_ = header.volume.voxel_count();
    stored_bytes_ = header.stored_bytes();
    return header;
  }

  void read_voxels(void* voxels) override {
    if (!is_plain_gzip()) return read_itk_voxels(*io_, path_, voxels, stored_bytes_);
    // ITK's reader does not verify the checksum, nor notice that the end of the stream is missing.
    const std::string data = fields_.value("datafile");
    if (data.empty()) {
      read_deflated(path_, fields_.header_bytes, 0, voxels, stored_bytes_);
    } else {
      read_deflated(path_.parent_path() / data, 0, 0, voxels, stored_bytes_);
    }
    if (fields_.value("endian") == "big") swap_bytes(voxels, count_, stored_bytes_ / count_);
  }

 private:
  /// NrrdIO reads "1e9" as 1.
  void check_sizes() const {
    std::istringstream words(fields_.value("sizes"));
    std::string word;
    for (unsigned a = 0; words >> word; ++a) {
      const bool is_number =
          std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
      if (!is_number ||
          (a < io_->GetNumberOfDimensions() && word != fmt::format("{}", io_->GetDimensions(a)))) {
        fail(ErrorCode::kBadFormat, path_,
             fmt::format("sizes: {}; expected whole numbers", fields_.value("sizes")));
      }
    }
  }

  bool is_plain_gzip() const {
    const std::string encoding = fields_.value("encoding");
    const std::string data = fields_.value("datafile");
    return (encoding == "gzip" || encoding == "gz") && fields_.value("lineskip").empty() &&
           fields_.value("byteskip").empty() && !data.starts_with("LIST") &&
           data.find_first_of("% ") == std::string::npos;
  }

  std::filesystem::path path_;
  itk::NrrdImageIO::Pointer io_;
  NrrdFields fields_;
  std::uint64_t count_ = 0;
  std::uint64_t stored_bytes_ = 0;
};

}  // namespace

std::unique_ptr<VolumeReader> make_nrrd_reader(const std::filesystem::path& path) {
  return std::make_unique<NrrdReader>(path);
}

}  // namespace voxlume
