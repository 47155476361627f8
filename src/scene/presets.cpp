#include "scene/presets.h"

#include <algorithm>
#include <cmath>

#include "scene/field_info.h"
#include "scene/hex_color.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

TransferPoint point(double value, double opacity, int hex) {
  TransferPoint p;
  p.value = value;
  p.opacity = opacity;
  p.color = hex_color(hex);
  return p;
}

constexpr int kSkin = 0xeec5ae, kMuscle = 0xc4776a, kVessel = 0xc06a5c, kBone = 0xeee3cf, kTooth = 0xf9f5ec;

std::vector<TransferPoint> ct_bone(const VolumeStatistics&) {
  return {point(140, 0, 0xd8ad90), point(220, 0.25, 0xe3c6a6), point(400, 0.9, kBone),
          point(1400, 0.98, kTooth), point(3000, 0.99, 0xfbfaf6)};
}

std::vector<TransferPoint> ct_skin(const VolumeStatistics&) {
  return {point(-500, 0, kSkin), point(-250, 0.55, kSkin), point(-50, 0.75, kSkin), point(300, 0.9, kSkin),
          point(700, 0.98, kBone)};
}

std::vector<TransferPoint> ct_muscle_bone(const VolumeStatistics&) {
  return {point(-30, 0, kMuscle),    point(20, 0.045, kMuscle),  point(90, 0.09, kMuscle),
          point(130, 0.05, kVessel), point(200, 0.25, 0xdcb598), point(400, 0.9, kBone),
          point(1400, 0.98, kTooth)};
}

/// Matter against air, opaque: the surface of a head.
std::vector<TransferPoint> mri_head(const VolumeStatistics& s) {
  const double air = otsu_threshold(s), bright = std::max<double>(s.percentile(0.995), air);
  const auto below = [&](double f) { return s.lower + f * (air - s.lower); };
  const auto at = [&](double f) { return air + f * (bright - air); };
  return {point(below(0.55), 0, 0xd9a996), point(below(0.9), 0.35, 0xe3b9a4), point(at(0.3), 0.75, 0xeac9b6),
          point(at(0.7), 0.9, 0xf0dccd), point(bright, 0.95, 0xf6eee4)};
}

std::vector<TransferPoint> fog(const VolumeStatistics& s) {
  const double lower = otsu_threshold(s);
  return {point(lower, 0, 0xf4f4f4),
          point(std::max<double>(s.percentile(0.999), std::nextafter(lower, INFINITY)), 0.02, 0xf4f4f4)};
}

std::vector<TransferPoint> generic(const VolumeStatistics& s) {
  const double lower = otsu_threshold(s);
  const double upper = std::max<double>(s.percentile(0.999), std::nextafter(lower, INFINITY));
  const double width = upper - lower;
  return {point(lower, 0, 0x4d6fa8), point(lower + 0.3 * width, 0.2, 0x7fb0c9),
          point(lower + 0.6 * width, 0.55, 0xe2c07a), point(upper, 0.9, 0xf6e9d2)};
}

}  // namespace

double otsu_threshold(const VolumeStatistics& statistics) {
  double total = 0, sum = 0;
  for (const auto& [value, count] : statistics.histogram) {
    total += static_cast<double>(count);
    sum += static_cast<double>(count) * value;
  }
  double below = 0, sum_below = 0, best = -1, threshold = statistics.lower;
  for (const auto& [value, count] : statistics.histogram) {
    below += static_cast<double>(count);
    sum_below += static_cast<double>(count) * value;
    const double above = total - below;
    if (above <= 0) break;
    const double gap = sum_below / below - (sum - sum_below) / above;
    const double variance = below * above * gap * gap;
    if (variance > best) {
      best = variance;
      threshold = value;
    }
  }
  return threshold;
}

const std::vector<Preset>& presets() {
  static const std::vector<Preset> all = {
      {"ct-bone", "CT (HU): bone and teeth, soft tissue removed", ct_bone},
      {"ct-skin", "CT (HU): the skin, opaque", ct_skin},
      {"ct-muscle-bone", "CT (HU): bone inside translucent muscle", ct_muscle_bone},
      {"mri-head", "MR: head or brain against air, thresholds from the data", mri_head},
      {"fog", "any data as thin white smoke, denser where the value is higher", fog},
      {"generic", "any data: background removed, blue to ivory with the value", generic},
  };
  return all;
}

const Preset& find_preset(std::string_view name) {
  std::vector<std::string_view> names;
  for (const Preset& preset : presets()) {
    if (preset.name == name) return preset;
    names.push_back(preset.name);
  }
  std::string list, near = nearest_word(name, names);
  for (const std::string_view n : names) list += (list.empty() ? "" : ", ") + std::string(n);
  throw Error(ErrorCode::kBadParameter, "/transfer/preset",
              "unknown preset \"" + std::string(name) + "\"" +
                  (near.empty() ? "; expected one of " + list : "; did you mean \"" + near + "\"?"));
}

bool is_hounsfield(const Volume& volume, const VolumeStatistics& statistics) {
  const bool air = statistics.lower <= -900 && statistics.lower >= -4096 && statistics.upper >= 300;
  return volume.modality == "CT" || (volume.modality.empty() && air);
}

const Preset& automatic_preset(const Volume& volume, const VolumeStatistics& statistics) {
  if (is_hounsfield(volume, statistics)) return find_preset("ct-bone");
  if (volume.modality == "MR" || volume.format == "NIfTI") return find_preset("mri-head");
  return find_preset("generic");
}

double longest_side_mm(const Volume& volume) {
  double longest = 0;
  for (int a = 0; a < 3; ++a)
    longest = std::max(longest, static_cast<double>(volume.size[a]) * volume.spacing_mm[a]);
  return longest;
}

double default_reference_length_mm(const Volume& volume, const VolumeStatistics& statistics) {
  if (is_hounsfield(volume, statistics)) return 1;
  return longest_side_mm(volume) / 256;
}

}  // namespace voxlume
