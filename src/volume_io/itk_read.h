#pragma once
#include <filesystem>
#include <memory>

#include "volume_io/file_format.h"
#include "volume_io/volume_reader.h"

namespace voxlume {

/// Reads NRRD and HDF5 through ITK, header and voxels.
std::unique_ptr<VolumeReader> make_itk_reader(const std::filesystem::path& path, FileFormat format);

/// Reads MetaImage and legacy VTK: ITK reads the header, the voxels are streamed straight into place, since ITK's
/// own readers hold a second copy of compressed voxels or take a short file for zeros.
std::unique_ptr<VolumeReader> make_meta_reader(const std::filesystem::path& path);
std::unique_ptr<VolumeReader> make_vtk_reader(const std::filesystem::path& path);

}  // namespace voxlume
