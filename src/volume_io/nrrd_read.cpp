#include <fmt/format.h>
#include <itkNrrdImageIO.h>

#include <algorithm>
#include <charconv>
#include <optional>
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

  VolumeHeader read_header(const Progress&) override {
    VolumeHeader header = read_itk_header(*io_, path_);
    header.volume.format = format_name(FileFormat::kNrrd);
    fields_ = read_nrrd_fields(path_);
    check_sizes();
    complete_nrrd_space(path_, fields_, header.volume);
    count_ = header.volume.voxel_count();
    stored_bytes_ = header.stored_bytes();
    in_file_ = find_raw_voxels();
    return header;
  }

  std::optional<VoxelsInFile> voxels_in_file() const override {
    if (!in_file_ || is_swapped()) return std::nullopt;
    return in_file_;
  }

  void read_voxels(void* voxels, const Progress& progress) override {
    const std::string encoding = fields_.value("encoding");
    if (in_file_) {
      read_plain(in_file_->path, in_file_->offset_bytes, voxels, stored_bytes_, progress);
    } else if ((encoding == "gzip" || encoding == "gz") && has_one_data_file() &&
               fields_.value("byteskip").empty()) {
      // ITK's reader does not verify the checksum, nor notice that the end of the stream is missing.
      read_deflated(data_path(), is_attached() ? fields_.header_bytes : 0, 0, voxels, stored_bytes_,
                    progress);
    } else {
      return read_itk_voxels(*io_, path_, voxels, stored_bytes_);
    }
    if (is_swapped()) swap_bytes(voxels, count_, stored_bytes_ / count_);
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

  bool is_attached() const { return fields_.value("datafile").empty(); }
  std::filesystem::path data_path() const {
    return is_attached() ? path_ : path_.parent_path() / fields_.value("datafile");
  }
  bool is_swapped() const { return fields_.value("endian") == "big" && stored_bytes_ > count_; }

  /// The data begin where the header ends, or with a file of their own.
  bool has_one_data_file() const {
    const std::string data = fields_.value("datafile");
    const std::string lines = fields_.value("lineskip");
    return (lines.empty() || lines == "0") && !data.starts_with("LIST") &&
           data.find_first_of("% ") == std::string::npos && (!data.empty() || fields_.header_bytes > 0);
  }

  /// Where raw voxels stand; none for other encodings, and for what ITK has to make out.
  std::optional<VoxelsInFile> find_raw_voxels() const {
    std::error_code error;
    const std::string endian = fields_.value("endian");
    const bool has_order = stored_bytes_ == count_ || endian == "little" || endian == "big";
    if (fields_.value("encoding") != "raw" || !has_order || !has_one_data_file()) return std::nullopt;
    const std::filesystem::path path = data_path();
    if (!std::filesystem::is_regular_file(path, error)) return std::nullopt;
    const std::uint64_t file_bytes = std::filesystem::file_size(path);
    std::uint64_t offset = is_attached() ? fields_.header_bytes : 0;
    const std::string skip = fields_.value("byteskip");
    std::uint64_t skip_bytes = 0;
    if (skip == "-1") {  // the voxels are the end of the file
      offset = std::max(offset, file_bytes - std::min(stored_bytes_, file_bytes));
    } else if (!skip.empty()) {
      const auto [end, failure] = std::from_chars(skip.data(), skip.data() + skip.size(), skip_bytes);
      if (failure != std::errc() || end != skip.data() + skip.size()) return std::nullopt;
      offset += std::min(skip_bytes, file_bytes);
    }
    const std::uint64_t data_bytes = file_bytes - std::min(offset, file_bytes);
    if (data_bytes < stored_bytes_) {
      fail(ErrorCode::kBadFormat, path,
           fmt::format("expected {} bytes of voxels, file has {}", stored_bytes_, data_bytes));
    }
    return VoxelsInFile{path, offset};
  }

  std::filesystem::path path_;
  itk::NrrdImageIO::Pointer io_;
  NrrdFields fields_;
  std::uint64_t count_ = 0;
  std::uint64_t stored_bytes_ = 0;
  std::optional<VoxelsInFile> in_file_;
};

}  // namespace

std::unique_ptr<VolumeReader> make_nrrd_reader(const std::filesystem::path& path) {
  return std::make_unique<NrrdReader>(path);
}

}  // namespace voxlume
