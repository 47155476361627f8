#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace voxlume {

/// What one frame says about its place and values.
struct DicomFrame {
  std::optional<std::array<double, 3>> position_mm;  ///< ImagePosition: LPS centre of the first pixel
  std::optional<std::array<double, 6>>
      orientation;                       ///< ImageOrientation: unit direction along a row, along a column
  std::array<double, 2> pixel_mm{0, 0};  ///< spacing along a row (i), along a column (j); 0 when not said
  double slope = 1;
  double intercept = 0;
};

/// The structural tags of one file. Nothing else of a DICOM file is ever kept: no name, date, place or
/// identifier but series_uid, which only tells series apart and leaves no further than the reader.
struct DicomFile {
  std::filesystem::path path;
  std::string series_uid;
  std::string modality;
  int series_number = 0;
  int instance_number = 0;
  int columns = 0;
  int rows = 0;
  int samples = 1;  ///< values per pixel
  int bits_allocated = 16;
  int bits_stored = 16;
  bool is_signed = false;
  bool inverted = false;  ///< MONOCHROME1
  bool palette = false;
  double tilt_degrees = 0;   ///< GantryDetectorTilt
  double slice_step_mm = 0;  ///< SpacingBetweenSlices, else SliceThickness; 0 when neither is there
  std::vector<DicomFrame> frames;
};

/// Reads the tags without the pixels; none when the file holds no image or cannot be parsed.
std::optional<DicomFile> read_dicom_tags(const std::filesystem::path& path);

/// Decodes all frames of a file into values as stored, `bytes_per_value` from bits_allocated.
/// Throws Error kBadFormat when pixels are missing, damaged or not of the size the tags say.
std::vector<char> read_dicom_pixels(const DicomFile& file);

/// True when a file begins as DICOM files do, with or without the preamble.
bool looks_like_dicom(const std::filesystem::path& path);

}  // namespace voxlume
