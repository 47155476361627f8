#include "volume_io/dicom_group.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/fail.h"

namespace voxlume {
namespace {

bool same_orientation(const DicomFrame& a, const DicomFrame& b) {
  constexpr double kSame = 0.01;
  if (a.orientation.has_value() != b.orientation.has_value()) return false;
  if (a.position_mm.has_value() != b.position_mm.has_value()) return false;
  if (!a.orientation) return true;
  for (int i = 0; i < 6; ++i) {
    if (std::abs((*a.orientation)[i] - (*b.orientation)[i]) > kSame) return false;
  }
  return true;
}

bool same_spacing(const DicomFrame& a, const DicomFrame& b) {
  const auto close = [](double x, double y) { return std::abs(x - y) <= 1e-3 * std::abs(x); };
  return close(a.pixel_mm[0], b.pixel_mm[0]) && close(a.pixel_mm[1], b.pixel_mm[1]);
}

bool belongs(const std::vector<DicomFile>& files, FrameRef a, FrameRef b) {
  const DicomFile& file_a = files[a.file];
  const DicomFile& file_b = files[b.file];
  return file_a.series_uid == file_b.series_uid && file_a.columns == file_b.columns &&
         file_a.rows == file_b.rows && file_a.samples == file_b.samples && file_a.palette == file_b.palette &&
         same_orientation(file_a.frames[a.frame], file_b.frames[b.frame]) &&
         same_spacing(file_a.frames[a.frame], file_b.frames[b.frame]);
}

std::vector<DicomGroup> make_groups(const std::vector<DicomFile>& files) {
  std::vector<DicomGroup> groups;
  for (std::size_t f = 0; f < files.size(); ++f) {
    for (std::size_t i = 0; i < files[f].frames.size(); ++i) {
      const FrameRef ref{f, i};
      // The last group first: files of one series come together.
      const auto found = std::find_if(groups.rbegin(), groups.rend(),
                                      [&](const DicomGroup& g) { return belongs(files, g.frames[0], ref); });
      if (found != groups.rend()) {
        found->frames.push_back(ref);
      } else {
        groups.push_back({{ref}});
      }
    }
  }
  for (DicomGroup& group : groups) {
    std::stable_sort(group.frames.begin(), group.frames.end(), [&](FrameRef a, FrameRef b) {
      return files[a.file].instance_number < files[b.file].instance_number;
    });
  }
  return groups;
}

std::uint64_t voxels_of(const std::vector<DicomFile>& files, const DicomGroup& group) {
  const DicomFile& file = files[group.frames[0].file];
  return static_cast<std::uint64_t>(file.columns) * static_cast<std::uint64_t>(file.rows) *
         group.frames.size();
}

std::string describe(const std::vector<DicomFile>& files, const DicomGroup& group) {
  const DicomFile& file = files[group.frames[0].file];
  return fmt::format("series {} ({}, {} slices of {}x{}{})", file.series_number,
                     file.modality.empty() ? "unknown modality" : file.modality, group.frames.size(),
                     file.columns, file.rows, file.samples > 1 ? ", colour" : "");
}

/// Why a group cannot be read; empty when it can.
std::string refusal(const std::vector<DicomFile>& files, const DicomGroup& group) {
  const DicomFile& file = files[group.frames[0].file];
  if (file.samples != 1) return fmt::format("{} values per pixel (colour); expected one", file.samples);
  if (file.palette) return "palette colours; expected grey values";
  if (file.frames.size() > 1 && !file.frames[group.frames[0].frame].position_mm) {
    return fmt::format(
        "multi-frame DICOM of {} frames without a position for each (a time series?); expected a "
        "position for each frame",
        file.frames.size());
  }
  return {};
}

}  // namespace

DicomGroup choose_series(const std::filesystem::path& where, const std::vector<DicomFile>& files,
                         std::vector<std::string>& warnings) {
  const std::vector<DicomGroup> groups = make_groups(files);
  const DicomGroup* best = nullptr;
  for (const DicomGroup& group : groups) {
    if (!refusal(files, group).empty()) continue;
    if (!best || voxels_of(files, group) > voxels_of(files, *best)) best = &group;
  }
  if (!best) fail(ErrorCode::kUnsupported, where, refusal(files, groups[0]));
  if (groups.size() > 1) {
    constexpr std::size_t kMaxListed = 8;
    std::string others;
    std::size_t listed = 0;
    for (const DicomGroup& group : groups) {
      if (&group == best || listed++ >= kMaxListed) continue;
      if (!others.empty()) others += ", ";
      others += describe(files, group);
    }
    if (listed > kMaxListed) others += fmt::format(" and {} more", listed - kMaxListed);
    warnings.push_back(fmt::format("{} series here; {} is read, being the largest; left out: {}",
                                   groups.size(), describe(files, *best), others));
  }
  return *best;
}

}  // namespace voxlume
