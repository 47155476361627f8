#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
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
  std::optional<RawSpec> raw;                       ///< read `path` as raw voxels
  std::optional<std::array<double, 3>> spacing_mm;  ///< overrides the file's spacing
  /// Refuse volumes of more than this many bytes; 0 takes what the machine has available (not asked of
  /// voxels that are mapped from their file).
  std::uint64_t memory_limit_bytes = 0;
  /// Hears of the share that is read, where it is known: growing, at most once a percent, by the thread that
  /// reads; 1 when all is read, and nothing after an error. Must not throw.
  std::function<void(double share)> progress;
};

/// Reads a volume: NRRD, NHDR, MetaImage, NIfTI-1 and -2, a DICOM folder (the largest series in it) or file,
/// a TIFF file or a folder of TIFF slices (in natural order of their names), legacy VTK, HDF5 (ITK image),
/// OpenVDB (the first float grid, as the dense box of its active voxels), or raw. The extension decides, else
/// the content.
///
/// Voxels keep the file's type, except: scaled NIfTI gives f32 or f64, rescaled DICOM the smallest type that
/// holds its range (f32 when the rescaling is not by integers), 64-bit integers that fit become i32, OpenVDB
/// gives f32. Places are LPS mm; OpenVDB world units are taken for mm. What had to be assumed or repaired is
/// in Volume::warnings.
///
/// All but raw is read in a forked child process, so that a damaged file cannot harm this one; the voxels
/// come through shared memory without a copy. Peak memory is the voxels plus some megabytes; 3 times a file's
/// pixels more for multi-frame DICOM. Safe to call from several threads.
///
/// Uncompressed little-endian voxels of raw, NRRD, NHDR, MetaImage and NIfTI files are mapped instead, when
/// their offset is a multiple of the voxel's size and their values are taken as they are: nothing is read
/// before it is touched. Such a file may be removed or replaced by another, but must not be changed in place
/// while its voxels are used; touching what was cut off ends the process (SIGBUS).
///
/// Throws Error: kFileNotFound, kBadFormat, kUnsupported (4-D, RGB, complex, ...), kOutOfMemory,
/// kBadParameter (of the options).
Volume read_volume(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes a volume in the format of the file name's extension (.nrrd .nhdr .mha .mhd .nii .nii.gz .tif .vtk
/// .h5 .vdb; a path ending in "/" or an existing empty folder gets a DICOM series). Written aside and
/// renamed; a header with separate data (.nhdr, .mhd) is never left pointing to other data.
///
/// What a format lacks is lost: .tif keeps spacing (as ImageJ writes it) but no origin or direction; .vdb
/// holds f32; a DICOM series u8, u16 and i16 (i8 is widened). The modality is kept by .nrrd, .nhdr and DICOM.
/// Throws Error: kUnsupported for an unknown extension, a type the format lacks, or a turned volume as .vtk,
/// which has no orientation; kBadParameter for a folder that is not empty; kInternal when the disk fails.
void write_volume(const Volume& volume, const std::filesystem::path& path);

}  // namespace voxlume
