#include <fmt/format.h>
#include <itkHDF5ImageIO.h>
#include <itkMetaDataObject.h>
#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkVTKImageIO.h>

#include <cmath>

#include "base/fail.h"
#include "volume_io/library_message.h"
#include "volume_io/volume_writers.h"

namespace voxlume {
namespace {

itk::ImageIOBase::Pointer make_io(FileFormat format) {
  switch (format) {
    case FileFormat::kMetaImage:
      return itk::MetaImageIO::New().GetPointer();
    case FileFormat::kNifti:
      return itk::NiftiImageIO::New().GetPointer();
    case FileFormat::kVtk:
      return itk::VTKImageIO::New().GetPointer();
    case FileFormat::kHdf5:
      return itk::HDF5ImageIO::New().GetPointer();
    default:
      return itk::NrrdImageIO::New().GetPointer();
  }
}

itk::IOComponentEnum component_of(VoxelType type) {
  using Component = itk::IOComponentEnum;
  switch (type) {
    case VoxelType::kU8:
      return Component::UCHAR;
    case VoxelType::kI8:
      return Component::CHAR;
    case VoxelType::kU16:
      return Component::USHORT;
    case VoxelType::kI16:
      return Component::SHORT;
    case VoxelType::kU32:
      return Component::UINT;
    case VoxelType::kI32:
      return Component::INT;
    case VoxelType::kF32:
      return Component::FLOAT;
    default:
      return Component::DOUBLE;
  }
}

bool is_identity(const std::array<double, 9>& m) {
  for (int i = 0; i < 9; ++i) {
    if (std::abs(m[i] - (i % 4 == 0 ? 1 : 0)) > 1e-6) return false;
  }
  return true;
}

}  // namespace

void write_itk(const Volume& volume, const std::filesystem::path& path, FileFormat format) {
  if (format == FileFormat::kVtk && !is_identity(volume.direction)) {
    fail(ErrorCode::kUnsupported, path,
         "legacy VTK carries no orientation and this volume is rotated or flipped; write .nrrd or .mha "
         "instead");
  }
  const itk::ImageIOBase::Pointer io = make_io(format);
  itk::ImageIORegion region(3);
  io->SetNumberOfDimensions(3);
  for (unsigned a = 0; a < 3; ++a) {
    io->SetDimensions(a, static_cast<itk::SizeValueType>(volume.size[a]));
    io->SetSpacing(a, volume.spacing_mm[a]);
    io->SetOrigin(a, volume.origin_mm[a]);
    io->SetDirection(a, {volume.direction[a], volume.direction[3 + a], volume.direction[6 + a]});
    region.SetSize(a, static_cast<itk::SizeValueType>(volume.size[a]));
  }
  io->SetComponentType(component_of(volume.type));
  io->SetPixelType(itk::IOPixelEnum::SCALAR);
  io->SetNumberOfComponents(1);
  io->SetIORegion(region);
  io->SetUseCompression(volume_extension(path) == ".nrrd" || volume_extension(path) == ".nii.gz");
  io->SetFileType(itk::IOFileEnum::Binary);
  io->SetFileName(path.string());
  if (format == FileFormat::kNrrd && !volume.modality.empty()) {
    itk::EncapsulateMetaData<std::string>(io->GetMetaDataDictionary(), "modality", volume.modality);
  }
  try {
    io->Write(volume.voxels.get());
  } catch (const itk::ExceptionObject& error) {
    fail(ErrorCode::kInternal, path, "cannot be written: " + library_message(error.GetDescription()));
  }
}

}  // namespace voxlume
