#include <fmt/format.h>
#include <gdcmAttribute.h>
#include <gdcmUIDGenerator.h>
#include <gdcmWriter.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/fail.h"
#include "volume_io/volume_writers.h"
#include "volume_io/voxel_convert.h"

namespace voxlume {
namespace {

/// A decimal string: at most 16 characters, which DICOM demands.
std::string decimal(double value) {
  std::string best = "0";
  for (int digits = 1; digits <= 16; ++digits) {
    const std::string text = fmt::format("{:.{}g}", value, digits);
    if (text.size() <= 16) best = text;
  }
  return best;
}

void put_text(gdcm::DataSet& data, gdcm::Tag tag, gdcm::VR vr, std::string text) {
  if (text.size() % 2) text += vr == gdcm::VR::UI ? '\0' : ' ';
  gdcm::DataElement element(tag);
  element.SetVR(vr);
  element.SetByteValue(text.data(), static_cast<std::uint32_t>(text.size()));
  data.Insert(element);
}

void put_word(gdcm::DataSet& data, gdcm::Tag tag, int value) {
  const char bytes[2] = {static_cast<char>(value & 0xff), static_cast<char>(value >> 8)};
  gdcm::DataElement element(tag);
  element.SetVR(gdcm::VR::US);
  element.SetByteValue(bytes, 2);
  data.Insert(element);
}

struct SeriesIds {
  std::string study;
  std::string series;
  std::string frame_of_reference;
};

const char* sop_class(const std::string& modality) {
  if (modality == "CT") return "1.2.840.10008.5.1.4.1.1.2";
  if (modality == "MR") return "1.2.840.10008.5.1.4.1.1.4";
  return "1.2.840.10008.5.1.4.1.1.7";  // secondary capture
}

void put_identity(gdcm::DataSet& data, const std::string& modality, const SeriesIds& ids,
                  std::int64_t slice) {
  gdcm::UIDGenerator uids;
  put_text(data, {0x0008, 0x0016}, gdcm::VR::UI, sop_class(modality));
  put_text(data, {0x0008, 0x0018}, gdcm::VR::UI, uids.Generate());
  put_text(data, {0x0008, 0x0060}, gdcm::VR::CS, modality);
  put_text(data, {0x0020, 0x000d}, gdcm::VR::UI, ids.study);
  put_text(data, {0x0020, 0x000e}, gdcm::VR::UI, ids.series);
  put_text(data, {0x0020, 0x0011}, gdcm::VR::IS, "1");
  put_text(data, {0x0020, 0x0013}, gdcm::VR::IS, fmt::format("{}", slice + 1));
  put_text(data, {0x0020, 0x0052}, gdcm::VR::UI, ids.frame_of_reference);
  // Required to be there, allowed to be empty.
  put_text(data, {0x0008, 0x0020}, gdcm::VR::DA, "");
  put_text(data, {0x0008, 0x0030}, gdcm::VR::TM, "");
  put_text(data, {0x0010, 0x0010}, gdcm::VR::PN, "");
  put_text(data, {0x0010, 0x0020}, gdcm::VR::LO, "");
}

void put_plane(gdcm::DataSet& data, const Volume& volume, std::int64_t slice) {
  const auto& d = volume.direction;
  std::string position;
  std::string orientation;
  for (int r = 0; r < 3; ++r) {
    const double depth = static_cast<double>(slice) * volume.spacing_mm[2];
    if (r) position += '\\';
    position += decimal(volume.origin_mm[r] + d[3 * r + 2] * depth);
  }
  for (int a = 0; a < 2; ++a) {
    for (int r = 0; r < 3; ++r) {
      if (a + r) orientation += '\\';
      orientation += decimal(d[3 * r + a]);
    }
  }
  put_text(data, {0x0018, 0x0050}, gdcm::VR::DS, decimal(volume.spacing_mm[2]));
  put_text(data, {0x0018, 0x0088}, gdcm::VR::DS, decimal(volume.spacing_mm[2]));
  put_text(data, {0x0020, 0x0032}, gdcm::VR::DS, position);
  put_text(data, {0x0020, 0x0037}, gdcm::VR::DS, orientation);
  put_text(data, {0x0028, 0x0030}, gdcm::VR::DS,
           fmt::format("{}\\{}", decimal(volume.spacing_mm[1]), decimal(volume.spacing_mm[0])));
}

void put_pixels(gdcm::DataSet& data, const Volume& volume, VoxelType type, std::int64_t slice) {
  const auto values = static_cast<std::uint64_t>(volume.size[0]) * static_cast<std::uint64_t>(volume.size[1]);
  const int bits = 8 * static_cast<int>(voxel_bytes(type));
  put_word(data, {0x0028, 0x0002}, 1);
  put_text(data, {0x0028, 0x0004}, gdcm::VR::CS, "MONOCHROME2");
  put_word(data, {0x0028, 0x0010}, static_cast<int>(volume.size[1]));
  put_word(data, {0x0028, 0x0011}, static_cast<int>(volume.size[0]));
  put_word(data, {0x0028, 0x0100}, bits);
  put_word(data, {0x0028, 0x0101}, bits);
  put_word(data, {0x0028, 0x0102}, bits - 1);
  put_word(data, {0x0028, 0x0103}, type == VoxelType::kI16 ? 1 : 0);
  put_text(data, {0x0028, 0x1052}, gdcm::VR::DS, "0");
  put_text(data, {0x0028, 0x1053}, gdcm::VR::DS, "1");
  std::vector<char> pixels(values * voxel_bytes(type));
  const auto* from = static_cast<const char*>(volume.voxels.get()) +
                     static_cast<std::uint64_t>(slice) * values * voxel_bytes(volume.type);
  rescale_voxels(from, volume.type, pixels.data(), type, values, 1, 0);
  if (pixels.size() % 2) pixels.push_back('\0');
  gdcm::DataElement element(gdcm::Tag(0x7fe0, 0x0010));
  element.SetVR(gdcm::VR::OW);
  element.SetByteValue(pixels.data(), static_cast<std::uint32_t>(pixels.size()));
  data.Insert(element);
}

void check_representable(const Volume& volume, const std::filesystem::path& folder) {
  constexpr std::int64_t kMaxSide = 65535;
  if (volume.size[0] > kMaxSide || volume.size[1] > kMaxSide || volume.size[2] > 1'000'000) {
    fail(ErrorCode::kUnsupported, folder,
         fmt::format("{}; DICOM slices are at most 65535 wide", fmt::join(volume.size, "x")));
  }
  constexpr std::int64_t kMaxSlicePixels = 0x7ffffffe;  // of up to 2 bytes, counted with 32 bits
  if (volume.size[0] * volume.size[1] > kMaxSlicePixels) {
    fail(ErrorCode::kUnsupported, folder,
         fmt::format("{}; a DICOM slice has fewer than 2^31 pixels", fmt::join(volume.size, "x")));
  }
  if (voxel_bytes(volume.type) > 2) {
    fail(ErrorCode::kUnsupported, folder,
         fmt::format("{} voxels; a DICOM series is written from u8, i8, u16 or i16",
                     voxel_type_name(volume.type)));
  }
}

}  // namespace

void write_dicom(const Volume& volume, const std::filesystem::path& folder) {
  check_representable(volume, folder);
  std::filesystem::create_directory(folder);
  const VoxelType type = volume.type == VoxelType::kI8 ? VoxelType::kI16 : volume.type;
  const std::string modality = volume.modality.empty() ? "OT" : volume.modality;
  gdcm::UIDGenerator uids;
  const SeriesIds ids{uids.Generate(), uids.Generate(), uids.Generate()};
  for (std::int64_t slice = 0; slice < volume.size[2]; ++slice) {
    const std::filesystem::path path = folder / fmt::format("slice{:05}.dcm", slice + 1);
    gdcm::Writer writer;
    gdcm::File& file = writer.GetFile();
    gdcm::DataSet& data = file.GetDataSet();
    put_identity(data, modality, ids, slice);
    put_plane(data, volume, slice);
    put_pixels(data, volume, type, slice);
    file.GetHeader().SetDataSetTransferSyntax(gdcm::TransferSyntax::ExplicitVRLittleEndian);
    writer.SetFileName(path.c_str());
    if (!writer.Write()) fail(ErrorCode::kInternal, path, "cannot be written (disk full?)");
  }
}

}  // namespace voxlume
