#pragma once
#include <itkImageIOBase.h>

#include <filesystem>

#include "volume_io/volume_reader.h"

namespace voxlume {

/// Runs ITK's ReadImageInformation and turns the result into a header. Throws Error kUnsupported for anything
/// but one scalar per voxel in at most three dimensions, kBadFormat when ITK refuses the file.
VolumeHeader read_itk_header(itk::ImageIOBase& io, const std::filesystem::path& path);

/// Reads the whole image into `voxels` (`bytes` of it). Throws Error kBadFormat with ITK's reason.
void read_itk_voxels(itk::ImageIOBase& io, const std::filesystem::path& path, void* voxels,
                     std::uint64_t bytes);

/// "CT", ... from the dictionary's entry "modality" (an NRRD key); empty when there is none.
std::string itk_modality(const itk::ImageIOBase& io);

}  // namespace voxlume
