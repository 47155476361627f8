#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "voxlume/volume.h"

namespace voxlume {

/// How to read a headerless file; the command line's `--raw WxHxD,type,sx,sy,sz[,endian][,offset]`.
struct RawSpec {
  std::array<std::int64_t, 3> size{0, 0, 0};
  VoxelType type = VoxelType::kU8;
  std::array<double, 3> spacing_mm{1, 1, 1};
  bool big_endian = false;
  std::uint64_t offset_bytes = 0;
};

/// Parses "256x256x108,i16,0.957,0.957,1.5[,little|big][,offset]".
/// Throws Error kBadParameter naming the field that is wrong and what was expected.
RawSpec parse_raw_spec(std::string_view text);

struct ReadOptions {
  std::optional<RawSpec> raw;                        ///< read `path` as raw voxels
  std::optional<std::array<double, 3>> spacing_mm;   ///< overrides the file's spacing
  /// Refuse volumes larger than this many bytes; 0 takes what the machine has available.
  std::uint64_t memory_limit_bytes = 0;
};

/// Reads a volume: NRRD, NHDR, MetaImage, NIfTI, a DICOM folder, a TIFF file or a folder of TIFF slices, legacy
/// VTK, HDF5 (ITK image), OpenVDB float grid, or raw. Voxels keep the file's type.
/// Throws Error: kFileNotFound, kBadFormat, kUnsupported (4-D, RGB, complex, ...), kOutOfMemory.
Volume read_volume(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes a volume in the format of the file name's extension (.nrrd .nhdr .mha .mhd .nii .nii.gz .tif .vtk .h5 .vdb;
/// a path ending in "/" or an existing folder gets a DICOM series). Written aside and renamed.
/// Throws Error: kUnsupported for an unknown extension or a type the format lacks, kInternal when the disk fails.
void write_volume(const Volume& volume, const std::filesystem::path& path);

}  // namespace voxlume
