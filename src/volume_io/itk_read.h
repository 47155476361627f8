#pragma once
#include <filesystem>
#include <memory>

#include "volume_io/volume_reader.h"

namespace voxlume {

/// Reads an HDF5 image as ITK writes it, header and voxels through ITK.
std::unique_ptr<VolumeReader> make_hdf5_reader(const std::filesystem::path& path);

/// Reads NRRD, attached or detached, through ITK; gzipped voxels are streamed straight into place.
std::unique_ptr<VolumeReader> make_nrrd_reader(const std::filesystem::path& path);

/// Reads MetaImage and legacy VTK: ITK reads the header, the voxels are streamed straight into place, since
/// ITK's own readers hold a second copy of compressed voxels or take a short file for zeros.
std::unique_ptr<VolumeReader> make_meta_reader(const std::filesystem::path& path);
std::unique_ptr<VolumeReader> make_vtk_reader(const std::filesystem::path& path);

}  // namespace voxlume
