#include <fmt/format.h>
#include <itkMetaImageIO.h>
#include <metaImage.h>

#include <fstream>
#include <string>

#include "base/fail.h"
#include "volume_io/file_format.h"
#include "volume_io/itk_header.h"
#include "volume_io/itk_read.h"
#include "volume_io/voxel_stream.h"

namespace voxlume {
namespace {

/// The offset of the byte after the line "ElementDataFile = ...", which ends a MetaImage header.
std::uint64_t header_end(const std::filesystem::path& path) {
  constexpr std::size_t kMaxHeaderBytes = 1 << 20;
  std::ifstream file(path, std::ios::binary);
  std::string start(kMaxHeaderBytes, '\0');
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  std::size_t line = 0;
  while (line < start.size()) {
    const std::size_t end = start.find('\n', line);
    if (end == std::string::npos) break;
    if (start.compare(line, 15, "ElementDataFile") == 0) return end + 1;
    line = end + 1;
  }
  fail(ErrorCode::kBadFormat, path, "the header has no ElementDataFile line; expected one at its end");
}

class MetaReader : public VolumeReader {
 public:
  explicit MetaReader(const std::filesystem::path& path) : path_(path), io_(itk::MetaImageIO::New()) {}

  VolumeHeader read_header(const Progress&) override {
    VolumeHeader header = read_itk_header(*io_, path_);
    header.volume.format = format_name(FileFormat::kMetaImage);
    if (io_->GetMetaImagePointer()->Modality() == MET_MOD_CT) header.volume.modality = "CT";
    if (io_->GetMetaImagePointer()->Modality() == MET_MOD_MR) header.volume.modality = "MR";
    count_ = header.volume.voxel_count();
    value_bytes_ = header.stored_bytes() / std::max<std::uint64_t>(count_, 1);
    type_ = header.volume.type;
    wide_ = header.wide != WideInteger::kNone;
    find_data();
    const std::uint64_t file_bytes = std::filesystem::file_size(data_path_);
    const MetaImage& meta = *io_->GetMetaImagePointer();
    if (meta.HeaderSize() > 0) offset_ = static_cast<std::uint64_t>(meta.HeaderSize());
    if (meta.HeaderSize() == -1 && file_bytes >= header.stored_bytes())
      offset_ = file_bytes - header.stored_bytes();
    const std::uint64_t data_bytes = file_bytes - std::min(offset_, file_bytes);
    if (meta.CompressedData()) {
      check_deflated_size(data_path_, data_bytes, header.stored_bytes());
    } else if (meta.BinaryData() && data_bytes < header.stored_bytes()) {
      fail(ErrorCode::kBadFormat, data_path_,
           fmt::format("expected {} bytes of voxels, file has {}", header.stored_bytes(), data_bytes));
    }
    return header;
  }

  std::optional<VoxelsInFile> voxels_in_file() const override {
    const MetaImage& meta = *io_->GetMetaImagePointer();
    const bool swapped = meta.BinaryDataByteOrderMSB() && value_bytes_ > 1;
    if (!meta.BinaryData() || meta.CompressedData() || swapped) return std::nullopt;
    return VoxelsInFile{data_path_, offset_};
  }

  void read_voxels(void* voxels, const Progress& progress) override {
    const MetaImage& meta = *io_->GetMetaImagePointer();
    if (!meta.BinaryData()) {
      if (wide_)
        fail(ErrorCode::kUnsupported, path_, "64-bit integers written as text; write them as binary first");
      return read_text(data_path_, offset_, type_, voxels, count_, progress);
    }
    if (meta.CompressedData()) {
      read_deflated(data_path_, offset_, 0, voxels, count_ * value_bytes_, progress);
    } else {
      read_plain(data_path_, offset_, voxels, count_ * value_bytes_, progress);
    }
    if (meta.BinaryDataByteOrderMSB()) swap_bytes(voxels, count_, value_bytes_);
  }

 private:
  void find_data() {
    const std::string name = one_line(io_->GetMetaImagePointer()->ElementDataFileName());
    if (name.empty() || name == "LOCAL" || name == "Local" || name == "local") {
      data_path_ = path_;
      offset_ = header_end(path_);
      return;
    }
    if (name.starts_with("LIST") || name.find('%') != std::string::npos) {
      fail(ErrorCode::kUnsupported, path_,
           fmt::format("ElementDataFile = {}: voxels spread over several files; expected one data file",
                       name));
    }
    data_path_ = path_.parent_path() / name;
    if (!std::filesystem::is_regular_file(data_path_)) {
      fail(ErrorCode::kFileNotFound, path_, fmt::format("its data file \"{}\" is not there", name));
    }
  }

  std::filesystem::path path_;
  itk::MetaImageIO::Pointer io_;
  std::filesystem::path data_path_;
  std::uint64_t offset_ = 0;
  std::uint64_t count_ = 0;
  std::size_t value_bytes_ = 1;
  VoxelType type_ = VoxelType::kU8;
  bool wide_ = false;
};

}  // namespace

std::unique_ptr<VolumeReader> make_meta_reader(const std::filesystem::path& path) {
  return std::make_unique<MetaReader>(path);
}

}  // namespace voxlume
