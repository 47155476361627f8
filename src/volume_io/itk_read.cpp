#include "volume_io/itk_read.h"

#include <fmt/format.h>
#include <itkHDF5ImageIO.h>
#include <itkNrrdImageIO.h>

#include <limits>

#include "volume_io/fail.h"
#include "volume_io/itk_header.h"
#include "volume_io/nrrd_space.h"
#include "volume_io/voxel_stream.h"

namespace voxlume {
namespace {

class ItkReader : public VolumeReader {
 public:
  ItkReader(const std::filesystem::path& path, FileFormat format) : path_(path), format_(format) {
    if (format == FileFormat::kNrrd) {
      io_ = itk::NrrdImageIO::New().GetPointer();
    } else {
      io_ = itk::HDF5ImageIO::New().GetPointer();
    }
  }

  VolumeHeader read_header() override {
    VolumeHeader header = read_itk_header(*io_, path_);
    header.volume.format = format_name(format_);
    if (format_ == FileFormat::kNrrd) complete_nrrd_space(path_, header.volume);
    stored_bytes_ = header.stored_bytes();
    return header;
  }

  void read_voxels(void* voxels) override {
    const unsigned dimensions = io_->GetNumberOfDimensions();
    itk::ImageIORegion region(dimensions);
    for (unsigned a = 0; a < dimensions; ++a) region.SetSize(a, io_->GetDimensions(a));
    io_->SetIORegion(region);
    if (static_cast<std::uint64_t>(io_->GetImageSizeInBytes()) != stored_bytes_) {
      fail(ErrorCode::kInternal, path_, "ITK and the header disagree about the size");
    }
    try {
      io_->Read(voxels);
    } catch (const itk::ExceptionObject& error) {
      fail(ErrorCode::kBadFormat, path_, "the voxels cannot be read: " + library_message(error.GetDescription()));
    }
  }

 private:
  std::filesystem::path path_;
  FileFormat format_;
  itk::ImageIOBase::Pointer io_;
  std::uint64_t stored_bytes_ = 0;
};

}  // namespace

std::unique_ptr<VolumeReader> make_itk_reader(const std::filesystem::path& path, FileFormat format) {
  return std::make_unique<ItkReader>(path, format);
}

}  // namespace voxlume
