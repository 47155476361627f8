#pragma once
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "test_files.h"

namespace voxlume::test {

/// Writes DICOM files byte by byte (explicit VR, little-endian), independent of the library under test.
/// Patient data are put in on purpose: none of them may come out again.
struct DicomBuilder {
  static constexpr int kColumns = 6;
  static constexpr int kRows = 4;

  std::string series = "1.2.3.4";
  int series_number = 2;
  std::string modality = "CT";
  std::array<double, 6> orientation{1, 0, 0, 0, 1, 0};
  std::string pixel_spacing = "0.7\\0.5";  // between rows, between columns
  std::string slope = "1";
  std::string intercept = "-1024";
  std::string tilt;
  int columns = kColumns;
  int rows = kRows;
  int samples = 1;
  int bits = 16;
  int bits_stored = 12;
  int is_signed = 0;
  int frames = 1;
  bool with_position = true;
  std::string groups;  ///< raw elements of group 5200

  using Elements = std::map<std::pair<int, int>, std::string>;

  static std::string element(int group, int number, const std::string& vr, std::string value) {
    if (value.size() % 2) value += vr == "UI" ? '\0' : ' ';
    std::string bytes = {static_cast<char>(group), static_cast<char>(group >> 8), static_cast<char>(number),
                         static_cast<char>(number >> 8)};
    bytes += vr;
    const auto length = static_cast<std::uint32_t>(value.size());
    if (vr == "OW" || vr == "OB" || vr == "SQ") {
      bytes += std::string(2, '\0') + bytes_of<std::uint32_t>({length});
    } else {
      bytes += bytes_of<std::uint16_t>({static_cast<std::uint16_t>(length)});
    }
    return bytes + value;
  }

  static std::string item(const std::string& content) {
    return bytes_of<std::uint16_t>({0xfffe, 0xe000}) +
           bytes_of<std::uint32_t>({static_cast<std::uint32_t>(content.size())}) + content;
  }

  static std::string position_text(const std::array<double, 3>& p) {
    return fmt::format("{:.6g}\\{:.6g}\\{:.6g}", p[0], p[1], p[2]);
  }

  std::string file(int instance, const std::array<double, 3>& position_mm, const std::string& pixels) const {
    Elements elements;
    const auto put = [&](int group, int number, const std::string& vr, const std::string& value) {
      elements[{group, number}] = element(group, number, vr, value);
    };
    const auto word = [](int value) { return bytes_of<std::uint16_t>({static_cast<std::uint16_t>(value)}); };
    put(0x0008, 0x0016, "UI", "1.2.840.10008.5.1.4.1.1.2");
    put(0x0008, 0x0018, "UI", fmt::format("{}.{}", series, instance));
    put(0x0008, 0x0020, "DA", "19991231");
    put(0x0008, 0x0060, "CS", modality);
    put(0x0008, 0x0080, "LO", "SecretHospital");
    put(0x0010, 0x0010, "PN", "SecretName^Jane");
    put(0x0010, 0x0020, "LO", "SecretId123");
    if (!tilt.empty()) put(0x0018, 0x1120, "DS", tilt);
    put(0x0018, 0x0050, "DS", "3");
    put(0x0020, 0x000d, "UI", "1.2.3");
    put(0x0020, 0x000e, "UI", series);
    put(0x0020, 0x0011, "IS", fmt::format("{}", series_number));
    put(0x0020, 0x0013, "IS", fmt::format("{}", instance));
    if (with_position) {
      std::string directions;
      for (const double d : orientation)
        directions += fmt::format("{}{:.9g}", directions.empty() ? "" : "\\", d);
      put(0x0020, 0x0032, "DS", position_text(position_mm));
      put(0x0020, 0x0037, "DS", directions);
    }
    put(0x0028, 0x0002, "US", word(samples));
    put(0x0028, 0x0004, "CS", samples == 1 ? "MONOCHROME2" : "RGB");
    if (samples > 1) put(0x0028, 0x0006, "US", word(0));
    if (frames > 1) put(0x0028, 0x0008, "IS", fmt::format("{}", frames));
    put(0x0028, 0x0010, "US", word(rows));
    put(0x0028, 0x0011, "US", word(columns));
    put(0x0028, 0x0030, "DS", pixel_spacing);
    put(0x0028, 0x0100, "US", word(bits));
    put(0x0028, 0x0101, "US", word(bits_stored));
    put(0x0028, 0x0102, "US", word(bits_stored - 1));
    put(0x0028, 0x0103, "US", word(is_signed));
    if (!slope.empty()) {
      put(0x0028, 0x1052, "DS", intercept);
      put(0x0028, 0x1053, "DS", slope);
    }
    std::string data;
    for (const auto& [tag, bytes] : elements) data += bytes;
    data += groups + element(0x7fe0, 0x0010, "OW", pixels);
    const std::string meta = element(0x0002, 0x0001, "OB", std::string("\0\1", 2)) +
                             element(0x0002, 0x0002, "UI", "1.2.840.10008.5.1.4.1.1.2") +
                             element(0x0002, 0x0003, "UI", fmt::format("{}.{}", series, instance)) +
                             element(0x0002, 0x0010, "UI", "1.2.840.10008.1.2.1");
    return std::string(128, '\0') + "DICM" +
           element(0x0002, 0x0000, "UL", bytes_of<std::uint32_t>({static_cast<std::uint32_t>(meta.size())})) +
           meta + data;
  }

  /// A slice whose every pixel is `value`, but for the first two, which count along the row.
  std::string slice(int instance, const std::array<double, 3>& position_mm, int value) const {
    std::vector<std::uint16_t> pixels(static_cast<std::size_t>(columns) * rows * samples,
                                      static_cast<std::uint16_t>(value));
    return file(instance, position_mm, bytes_of(pixels));
  }
};

}  // namespace voxlume::test
