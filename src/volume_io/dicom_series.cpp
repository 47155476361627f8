#include "volume_io/dicom_series.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/fail.h"
#include "volume_io/dicom_group.h"
#include "volume_io/slice_order.h"
#include "volume_io/voxel_convert.h"

namespace voxlume {
namespace {

using Vec = std::array<double, 3>;

VoxelType stored_type(const std::filesystem::path& where, const DicomFile& file) {
  switch (file.bits_allocated) {
    case 8:
      return file.is_signed ? VoxelType::kI8 : VoxelType::kU8;
    case 16:
      return file.is_signed ? VoxelType::kI16 : VoxelType::kU16;
    case 32:
      return file.is_signed ? VoxelType::kI32 : VoxelType::kU32;
    default:
      fail(ErrorCode::kUnsupported, where,
           fmt::format("DICOM pixels of {} bits; expected 8, 16 or 32", file.bits_allocated));
  }
}

/// The smallest type that holds every value a slice can have after rescaling; f32 when they are not integers.
VoxelType rescaled_type(const DicomGroup& group, const std::vector<DicomFile>& files) {
  double lowest = 0;
  double highest = 0;
  for (const FrameRef& ref : group.frames) {
    const DicomFile& file = files[ref.file];
    const DicomFrame& frame = file.frames[ref.frame];
    if (frame.slope != std::floor(frame.slope) || frame.intercept != std::floor(frame.intercept))
      return VoxelType::kF32;
    const int bits = std::clamp(file.bits_stored, 1, file.bits_allocated);
    const double first = file.is_signed ? -std::exp2(bits - 1) : 0;
    const double last = file.is_signed ? std::exp2(bits - 1) - 1 : std::exp2(bits) - 1;
    const double a = first * frame.slope + frame.intercept;
    const double b = last * frame.slope + frame.intercept;
    lowest = std::min({lowest, a, b});
    highest = std::max({highest, a, b});
  }
  if (lowest >= 0 && highest <= 0xff) return VoxelType::kU8;
  if (lowest >= 0 && highest <= 0xffff) return VoxelType::kU16;
  if (lowest >= -0x8000 && highest <= 0x7fff) return VoxelType::kI16;
  if (lowest >= -0x1p31 && highest <= 0x1p31 - 1) return VoxelType::kI32;
  if (lowest >= 0 && highest <= 0x1p32 - 1) return VoxelType::kU32;
  return VoxelType::kF64;
}

Vec normalised(const Vec& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

class DicomReader : public VolumeReader {
 public:
  DicomReader(const std::filesystem::path& where, std::vector<std::filesystem::path> paths)
      : where_(where), paths_(std::move(paths)) {}

  VolumeHeader read_header(const Progress& progress) override {
    VolumeHeader header;
    Volume& volume = header.volume;
    files_ = read_tags(volume, progress);
    group_ = choose_series(where_, files_, volume.warnings);
    const DicomFile& first = first_file();
    volume.modality = first.modality;
    volume.format = paths_.size() == 1 ? "DICOM" : "DICOM series";
    volume.type = type_ = choose_type();
    place(volume);
    warn(volume);
    header.working_bytes = working_bytes();
    slice_values_ = static_cast<std::uint64_t>(first.columns) * static_cast<std::uint64_t>(first.rows);
    return header;
  }

  void read_voxels(void* voxels, const Progress& progress) override {
    auto* out = static_cast<unsigned char*>(voxels);
    const std::uint64_t slice_bytes = slice_values_ * voxel_bytes(type_);
    std::vector<std::size_t> present;
    for (std::size_t s = 0; s < order_.slots.size(); ++s) {
      if (order_.slots[s] != SliceOrder::kMissing) present.push_back(s);
    }
    // By file, so that each is decoded once whatever the order of its frames.
    std::stable_sort(present.begin(), present.end(), [&](std::size_t a, std::size_t b) {
      return group_.frames[order_.slots[a]].file < group_.frames[order_.slots[b]].file;
    });
    std::size_t open_file = SliceOrder::kMissing;
    std::vector<char> pixels;
    ProgressCounter slices(static_cast<std::int64_t>(present.size()), progress);
    for (const std::size_t s : present) {
      const FrameRef ref = group_.frames[order_.slots[s]];
      const DicomFile& file = files_[ref.file];
      if (ref.file != open_file) pixels = read_dicom_pixels(file);
      open_file = ref.file;
      const std::size_t stored_bytes = slice_values_ * static_cast<unsigned>(file.bits_allocated / 8);
      const DicomFrame& frame = file.frames[ref.frame];
      rescale_voxels(pixels.data() + ref.frame * stored_bytes, stored_type(file.path, file),
                     out + s * slice_bytes, type_, slice_values_, frame.slope, frame.intercept);
      slices.add();
    }
    fill_missing(out, slice_bytes);
  }

 private:
  const DicomFile& first_file() const { return files_[group_.frames[0].file]; }

  std::vector<DicomFile> read_tags(Volume& volume, const Progress& progress) const {
    std::vector<DicomFile> files;
    std::size_t unreadable = 0;
    ProgressCounter seen(static_cast<std::int64_t>(paths_.size()), progress);
    for (const std::filesystem::path& path : paths_) {
      seen.add();
      if (!looks_like_dicom(path)) continue;
      if (auto file = read_dicom_tags(path)) {
        files.push_back(std::move(*file));
      } else {
        ++unreadable;
      }
    }
    if (files.empty()) {
      fail(ErrorCode::kBadFormat, where_,
           fmt::format("no readable DICOM image here ({} file(s) looked at); expected a series",
                       paths_.size()));
    }
    if (unreadable > 0) {
      volume.warnings.push_back(
          fmt::format("{} DICOM file(s) hold no image or are damaged; they are left out", unreadable));
    }
    return files;
  }

  VoxelType choose_type() const {
    bool as_stored = true;
    const VoxelType stored = stored_type(where_, first_file());
    for (const FrameRef& ref : group_.frames) {
      const DicomFile& file = files_[ref.file];
      const DicomFrame& frame = file.frames[ref.frame];
      as_stored =
          as_stored && stored_type(file.path, file) == stored && frame.slope == 1 && frame.intercept == 0;
    }
    return as_stored ? stored : rescaled_type(group_, files_);
  }

  void place(Volume& volume) {
    const DicomFile& file = first_file();
    const DicomFrame& frame = file.frames[group_.frames[0].frame];
    volume.spacing_mm = {frame.pixel_mm[0], frame.pixel_mm[1],
                         file.slice_step_mm > 0 ? file.slice_step_mm : 1};
    if (frame.pixel_mm[0] == 0 && frame.pixel_mm[1] == 0) {
      volume.spacing_mm[0] = volume.spacing_mm[1] = 1;
      volume.warnings.push_back("the DICOM files give no pixel spacing; 1 mm is assumed");
    }
    if (frame.orientation) {
      const auto& o = *frame.orientation;
      const Vec row = normalised({o[0], o[1], o[2]});
      const Vec column = normalised({o[3], o[4], o[5]});
      const Vec normal =
          normalised({row[1] * column[2] - row[2] * column[1], row[2] * column[0] - row[0] * column[2],
                      row[0] * column[1] - row[1] * column[0]});
      for (int r = 0; r < 3; ++r) {
        volume.direction[3 * r] = row[r];
        volume.direction[3 * r + 1] = column[r];
        volume.direction[3 * r + 2] = normal[r];
      }
    }
    order(volume);
    volume.size = {file.columns, file.rows, static_cast<std::int64_t>(order_.slots.size())};
  }

  /// Orders the slices by position, or by instance number where they give none.
  void order(Volume& volume) {
    const DicomFrame& frame = first_file().frames[group_.frames[0].frame];
    if (!frame.position_mm || !frame.orientation) {
      for (std::size_t i = 0; i < group_.frames.size(); ++i) order_.slots.push_back(i);
      if (group_.frames.size() > 1) {
        volume.warnings.push_back(
            fmt::format("the slices give no position: ordered by instance number, {:.4g} mm apart",
                        volume.spacing_mm[2]));
      }
      return;
    }
    std::vector<Vec> positions;
    for (const FrameRef& ref : group_.frames)
      positions.push_back(*files_[ref.file].frames[ref.frame].position_mm);
    order_ = order_slices(positions, {volume.direction[2], volume.direction[5], volume.direction[8]});
    volume.origin_mm = positions[order_.slots[0]];
    if (order_.step_mm > 0) volume.spacing_mm[2] = order_.step_mm;
    volume.warnings.insert(volume.warnings.end(), order_.warnings.begin(), order_.warnings.end());
  }

  void warn(Volume& volume) const {
    const DicomFile& file = first_file();
    const bool sheared = std::any_of(volume.warnings.begin(), volume.warnings.end(),
                                     [](const std::string& w) { return w.starts_with("gantry tilt"); });
    if (std::abs(file.tilt_degrees) > 0.1 && !sheared) {
      volume.warnings.push_back(fmt::format(
          "gantry tilt of {:.1f} degrees in the tags, but the slices are not sheared (already corrected?)",
          file.tilt_degrees));
    }
    if (file.inverted)
      volume.warnings.push_back("MONOCHROME1: low values are meant to be bright; values are kept");
    if (group_.frames.size() == 1)
      volume.warnings.push_back("a single slice; give the folder to read a whole series");
  }

  /// gdcm holds a file's pixels and the decoded copy at once.
  std::uint64_t working_bytes() const {
    std::uint64_t most = 0;
    for (const DicomFile& file : files_) {
      most = std::max(most, static_cast<std::uint64_t>(file.columns) * static_cast<unsigned>(file.rows) *
                                file.frames.size() * static_cast<unsigned>(file.bits_allocated / 8));
    }
    return 3 * most;
  }

  /// Linear interpolation between the nearest slices that are there.
  void fill_missing(unsigned char* out, std::uint64_t slice_bytes) const {
    std::size_t below = 0;
    for (std::size_t s = 1; s < order_.slots.size(); ++s) {
      if (order_.slots[s] != SliceOrder::kMissing) {
        below = s;
        continue;
      }
      std::size_t above = s;
      while (order_.slots[above] == SliceOrder::kMissing) ++above;
      const double weight = static_cast<double>(s - below) / static_cast<double>(above - below);
      with_voxel_type(type_, [&](auto zero) {
        using T = decltype(zero);
        const T* a = reinterpret_cast<const T*>(out + below * slice_bytes);
        const T* b = reinterpret_cast<const T*>(out + above * slice_bytes);
        T* to = reinterpret_cast<T*>(out + s * slice_bytes);
        for (std::uint64_t i = 0; i < slice_values_; ++i) {
          const double value = static_cast<double>(a[i]) * (1 - weight) + static_cast<double>(b[i]) * weight;
          to[i] = static_cast<T>(std::is_floating_point_v<T> ? value : std::nearbyint(value));
        }
      });
    }
  }

  std::filesystem::path where_;
  std::vector<std::filesystem::path> paths_;
  std::vector<DicomFile> files_;
  DicomGroup group_;
  SliceOrder order_;
  VoxelType type_ = VoxelType::kU8;
  std::uint64_t slice_values_ = 0;
};

}  // namespace

std::unique_ptr<VolumeReader> make_dicom_reader(const std::filesystem::path& where,
                                                std::vector<std::filesystem::path> files) {
  return std::make_unique<DicomReader>(where, std::move(files));
}

bool has_dicom(const std::vector<std::filesystem::path>& files) {
  return std::any_of(files.begin(), files.end(), looks_like_dicom);
}

}  // namespace voxlume
