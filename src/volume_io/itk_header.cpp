#include "volume_io/itk_header.h"

#include <fmt/format.h>
#include <itkMetaDataObject.h>

#include <algorithm>

#include "base/fail.h"
#include "volume_io/library_message.h"

namespace voxlume {
namespace {

using Component = itk::IOComponentEnum;

[[noreturn]] void fail_type(const std::filesystem::path& path, const std::string& found) {
  fail(ErrorCode::kUnsupported, path,
       fmt::format("voxels of type {}; expected 8, 16 or 32-bit integers or floating point", found));
}

void set_type(const itk::ImageIOBase& io, const std::filesystem::path& path, VolumeHeader& header) {
  const std::size_t bytes = io.GetComponentSize();
  VoxelType& type = header.volume.type;
  switch (io.GetComponentType()) {
    case Component::UCHAR:
      type = VoxelType::kU8;
      break;
    case Component::CHAR:
      type = VoxelType::kI8;
      break;
    case Component::USHORT:
      type = VoxelType::kU16;
      break;
    case Component::SHORT:
      type = VoxelType::kI16;
      break;
    case Component::UINT:
    case Component::ULONG:
    case Component::ULONGLONG:
      type = VoxelType::kU32;
      break;
    case Component::INT:
    case Component::LONG:
    case Component::LONGLONG:
      type = VoxelType::kI32;
      break;
    case Component::FLOAT:
      type = VoxelType::kF32;
      break;
    case Component::DOUBLE:
      type = VoxelType::kF64;
      break;
    default:
      fail_type(path, itk::ImageIOBase::GetComponentTypeAsString(io.GetComponentType()));
  }
  if (bytes == voxel_bytes(type)) return;
  if (bytes != 8) fail_type(path, fmt::format("of {} bytes", bytes));
  header.wide = type == VoxelType::kU32 ? WideInteger::kU64 : WideInteger::kI64;
  type = VoxelType::kI32;
  header.volume.warnings.push_back(kNarrowedWarning);
}

void check_pixel(const itk::ImageIOBase& io, const std::filesystem::path& path) {
  const std::string kind = itk::ImageIOBase::GetPixelTypeAsString(io.GetPixelType());
  if (io.GetPixelType() == itk::IOPixelEnum::COMPLEX) {
    fail(ErrorCode::kUnsupported, path,
         "complex voxels; expected one number per voxel; store magnitude or phase first");
  }
  if (io.GetNumberOfComponents() != 1) {
    fail(ErrorCode::kUnsupported, path,
         fmt::format("{} numbers per voxel ({}); expected one; extract one channel first, with 3D Slicer or "
                     "ImageJ for instance",
                     io.GetNumberOfComponents(), kind));
  }
}

void check_dimensions(const itk::ImageIOBase& io, const std::filesystem::path& path) {
  const unsigned dimensions = io.GetNumberOfDimensions();
  bool flat = true;
  std::string size;
  for (unsigned a = 0; a < dimensions; ++a) {
    size += fmt::format("{}{}", a ? "x" : "", io.GetDimensions(a));
    flat = flat && (a < 3 || io.GetDimensions(a) == 1);
  }
  if (dimensions < 1) fail(ErrorCode::kBadFormat, path, "the header gives no dimensions");
  if (!flat) {
    fail(
        ErrorCode::kUnsupported, path,
        fmt::format(
            "{}-D image {}; expected 3-D; extract one time step first, with 3D Slicer or ImageJ for instance",
            dimensions, size));
  }
}

}  // namespace

VolumeHeader read_itk_header(itk::ImageIOBase& io, const std::filesystem::path& path) {
  try {
    io.SetFileName(path.string());
    io.ReadImageInformation();
  } catch (const itk::ExceptionObject& error) {
    fail(ErrorCode::kBadFormat, path,
         "the header cannot be read: " + library_message(error.GetDescription()));
  }
  check_pixel(io, path);
  check_dimensions(io, path);
  VolumeHeader header;
  set_type(io, path, header);
  Volume& volume = header.volume;
  const unsigned dimensions = std::min(io.GetNumberOfDimensions(), 3u);
  volume.size = {1, 1, 1};
  for (unsigned a = 0; a < dimensions; ++a) {
    volume.size[a] = static_cast<std::int64_t>(io.GetDimensions(a));
    volume.spacing_mm[a] = io.GetSpacing(a);
    volume.origin_mm[a] = io.GetOrigin(a);
    const std::vector<double> axis = io.GetDirection(a);
    for (unsigned r = 0; r < dimensions && r < axis.size(); ++r) volume.direction[3 * r + a] = axis[r];
  }
  volume.modality = itk_modality(io);
  return header;
}

void read_itk_voxels(itk::ImageIOBase& io, const std::filesystem::path& path, void* voxels,
                     std::uint64_t bytes) {
  const unsigned dimensions = io.GetNumberOfDimensions();
  itk::ImageIORegion region(dimensions);
  for (unsigned a = 0; a < dimensions; ++a) region.SetSize(a, io.GetDimensions(a));
  io.SetIORegion(region);
  if (static_cast<std::uint64_t>(io.GetImageSizeInBytes()) != bytes) {
    fail(ErrorCode::kInternal, path, "ITK and the header disagree about the size");
  }
  try {
    io.Read(voxels);
  } catch (const itk::ExceptionObject& error) {
    fail(ErrorCode::kBadFormat, path,
         "the voxels cannot be read: " + library_message(error.GetDescription()));
  }
}

std::string itk_modality(const itk::ImageIOBase& io) {
  std::string value;
  if (!itk::ExposeMetaData<std::string>(io.GetMetaDataDictionary(), "modality", value)) return {};
  const bool plain = std::all_of(value.begin(), value.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
  return plain && value.size() >= 2 && value.size() <= 4 ? value : "";
}

}  // namespace voxlume
