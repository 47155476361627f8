#include "volume_io/itk_read.h"

#include <itkHDF5ImageIO.h>

#include "base/fail.h"
#include "volume_io/file_format.h"
#include "volume_io/hdf5_links.h"
#include "volume_io/itk_header.h"

namespace voxlume {
namespace {

class Hdf5Reader : public VolumeReader {
 public:
  explicit Hdf5Reader(const std::filesystem::path& path) : path_(path), io_(itk::HDF5ImageIO::New()) {}

  VolumeHeader read_header(const Progress&) override {
    check_hdf5_is_one_file(path_);
    VolumeHeader header = read_itk_header(*io_, path_);
    header.volume.format = format_name(FileFormat::kHdf5);
    stored_bytes_ = header.stored_bytes();
    return header;
  }

  void read_voxels(void* voxels, const Progress&) override {
    read_itk_voxels(*io_, path_, voxels, stored_bytes_);
  }

 private:
  std::filesystem::path path_;
  itk::HDF5ImageIO::Pointer io_;
  std::uint64_t stored_bytes_ = 0;
};

}  // namespace

std::unique_ptr<VolumeReader> make_hdf5_reader(const std::filesystem::path& path) {
  return std::make_unique<Hdf5Reader>(path);
}

}  // namespace voxlume
