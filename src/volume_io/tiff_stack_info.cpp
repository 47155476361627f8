#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "volume_io/tiff_file.h"

namespace voxlume {
namespace {

/// The text after `key` up to one of `ends`; empty when the key is absent.
std::string_view text_after(std::string_view text, std::string_view key, std::string_view ends) {
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + key.size());
  return text.substr(0, text.find_first_of(ends));
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value) || value <= 0) return std::nullopt;
  return value;
}

std::int64_t count(std::string_view text, std::int64_t otherwise) {
  const std::optional<double> value = number(text);
  return value && *value < 1e9 ? static_cast<std::int64_t>(*value) : otherwise;
}

/// Millimetres of a unit as ImageJ and OME write it.
std::optional<double> unit_mm(std::string_view unit) {
  if (unit == "mm" || unit == "millimeter") return 1;
  if (unit == "cm") return 10;
  if (unit == "m") return 1000;
  if (unit == "inch" || unit == "in") return 25.4;
  if (unit == "nm") return 1e-6;
  if (unit == "micron" || unit == "um" || unit == "\xc2\xb5m" || unit == "\xce\xbcm" || unit == "\\u00B5m" ||
      unit == "\xb5m") {
    return 1e-3;
  }
  return std::nullopt;
}

void read_ome(std::string_view text, TiffStackInfo& info) {
  info.channels = count(text_after(text, " SizeC=\"", "\""), 1);
  info.frames = count(text_after(text, " SizeT=\"", "\""), 1);
  constexpr std::string_view kAxes[] = {"X", "Y", "Z"};
  bool complete = true;
  for (int a = 0; a < 3; ++a) {
    const auto size = number(text_after(text, fmt::format(" PhysicalSize{}=\"", kAxes[a]), "\""));
    const auto unit = text_after(text, fmt::format(" PhysicalSize{}Unit=\"", kAxes[a]), "\"");
    const auto mm = unit_mm(unit.empty() ? "um" : unit);
    complete = complete && size && mm;
    info.spacing_mm[a] = size && mm ? *size * *mm : (a > 0 ? info.spacing_mm[0] : 1);
  }
  if (!complete)
    info.warning = "the OME description does not give every pixel size; the missing ones are assumed";
}

/// Pixels per resolution unit along x and y; none when the tags are absent or senseless.
std::optional<std::array<double, 2>> resolution(TIFF* tiff) {
  float x = 0;
  float y = 0;
  if (!TIFFGetField(tiff, TIFFTAG_XRESOLUTION, &x) || !TIFFGetField(tiff, TIFFTAG_YRESOLUTION, &y)) return {};
  if (!(std::isfinite(x) && std::isfinite(y) && x > 0 && y > 0)) return {};
  return std::array<double, 2>{x, y};
}

void read_imagej(TIFF* tiff, std::string_view text, TiffStackInfo& info) {
  info.channels = count(text_after(text, "\nchannels=", "\n"), 1);
  info.frames = count(text_after(text, "\nframes=", "\n"), 1);
  info.slices = count(text_after(text, "\nimages=", "\n"), 0);
  const auto mm = unit_mm(text_after(text, "\nunit=", "\n"));
  const auto per_unit = resolution(tiff);
  const auto depth = number(text_after(text, "\nspacing=", "\n"));
  if (!mm || !per_unit) {
    info.warning = "the TIFF gives no unit of length; 1 mm per pixel is assumed";
    if (per_unit && depth) info.spacing_mm = {1, (*per_unit)[0] / (*per_unit)[1], *depth * (*per_unit)[0]};
    return;
  }
  info.spacing_mm = {*mm / (*per_unit)[0], *mm / (*per_unit)[1], depth.value_or(1 / (*per_unit)[0]) * *mm};
  if (!depth) info.warning = "the TIFF gives no slice spacing; it is assumed to equal the pixel spacing";
}

}  // namespace

TiffStackInfo tiff_stack_info(TIFF* tiff) {
  TiffStackInfo info;
  const char* description = nullptr;
  const std::string_view text =
      TIFFGetField(tiff, TIFFTAG_IMAGEDESCRIPTION, &description) && description ? description : "";
  if (text.starts_with("ImageJ=")) {
    read_imagej(tiff, text, info);
    return info;
  }
  if (text.find("<OME") != std::string_view::npos) {
    read_ome(text, info);
    return info;
  }
  std::uint16_t unit = RESUNIT_INCH;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_RESOLUTIONUNIT, &unit);
  const auto per_unit = resolution(tiff);
  if (!per_unit || unit == RESUNIT_NONE) {
    info.warning = "the TIFF gives no spacing; 1 mm is assumed";
    return info;
  }
  const double mm = unit == RESUNIT_CENTIMETER ? 10 : 25.4;
  info.spacing_mm = {mm / (*per_unit)[0], mm / (*per_unit)[1], mm / (*per_unit)[0]};
  info.warning =
      fmt::format("the TIFF gives no slice spacing; it is assumed to equal the pixel spacing, {:.4g} mm",
                  info.spacing_mm[0]);
  return info;
}

}  // namespace voxlume
