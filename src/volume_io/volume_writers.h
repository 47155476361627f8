#pragma once
#include <filesystem>

#include "volume_io/file_format.h"
#include "voxlume/volume.h"

namespace voxlume {

// Each writes one format to `path`, which does not exist yet and is moved into place by write_volume. They
// throw Error kUnsupported for a type or orientation the format lacks, kInternal when writing fails.

/// NRRD, MetaImage, NIfTI, legacy VTK and HDF5. Detached headers (.nhdr, .mhd) get their data beside them.
/// NRRD and .nii.gz are compressed. Legacy VTK carries no direction: only identity is written.
void write_itk(const Volume& volume, const std::filesystem::path& path, FileFormat format);

/// One page a slice, with an ImageJ description that keeps the spacing; origin and direction are lost.
void write_tiff(const Volume& volume, const std::filesystem::path& path);

/// A float grid named "density" with every voxel active; other types are converted to f32.
void write_vdb(const Volume& volume, const std::filesystem::path& path);

/// A series of single-slice files in the new folder `folder`: u8, i8 (as i16), u16 and i16. No patient data.
/// A volume with left-handed axes reads back with its slices in reverse order, at the same places.
void write_dicom(const Volume& volume, const std::filesystem::path& folder);

}  // namespace voxlume
