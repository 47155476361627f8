#pragma once
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "volume_io/dicom_file.h"

namespace voxlume {

/// A frame of a file, by index into the files' list and the file's frames.
struct FrameRef {
  std::size_t file = 0;
  std::size_t frame = 0;
};

/// Frames that can make one volume: same series, size, orientation and pixel spacing. In instance order.
struct DicomGroup {
  std::vector<FrameRef> frames;
};

/// The group with the most voxels. The other groups are listed in `warnings`, by series number, never by
/// name. Throws Error kUnsupported when no group is a stack of one-valued pixels with a position for each
/// frame.
DicomGroup choose_series(const std::filesystem::path& where, const std::vector<DicomFile>& files,
                         std::vector<std::string>& warnings);

}  // namespace voxlume
