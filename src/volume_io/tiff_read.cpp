#include "volume_io/tiff_read.h"

#include <fmt/format.h>

#include "base/fail.h"
#include "volume_io/tiff_file.h"
#include "volume_io/voxel_stream.h"

namespace voxlume {
namespace {

bool is_thumbnail(TIFF* tiff) {
  std::uint32_t kind = 0;
  return TIFFGetField(tiff, TIFFTAG_SUBFILETYPE, &kind) && (kind & FILETYPE_REDUCEDIMAGE) != 0;
}

void warn_about_colours(TIFF* tiff, Volume& volume) {
  std::uint16_t photometric = PHOTOMETRIC_MINISBLACK;
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  if (photometric == PHOTOMETRIC_PALETTE)
    volume.warnings.push_back("the TIFF has a colour palette; its indices are read");
  if (photometric == PHOTOMETRIC_MINISWHITE) {
    volume.warnings.push_back("the TIFF shows low values as white; the values are read as they are");
  }
}

class TiffReader : public VolumeReader {
 public:
  explicit TiffReader(std::vector<std::filesystem::path> files) : files_(std::move(files)) {}

  VolumeHeader read_header(const Progress& progress) override {
    VolumeHeader header;
    Volume& volume = header.volume;
    const TiffFile first = open_tiff(files_[0]);
    page_ = tiff_page(first.get(), files_[0]);
    const TiffStackInfo info = tiff_stack_info(first.get());
    if (info.channels > 1 || info.frames > 1) {
      fail(ErrorCode::kUnsupported, files_[0],
           fmt::format("a stack of {} channels and {} time steps; expected one of each; extract one first, "
                       "with 3D Slicer or ImageJ for instance",
                       info.channels, info.frames));
    }
    warn_about_colours(first.get(), volume);
    std::int64_t slices = static_cast<std::int64_t>(files_.size());
    if (files_.size() == 1) {
      slices = count_pages(first.get());
      contiguous_ = slices == 1 && info.slices > 1;
      if (contiguous_) slices = check_contiguous(info.slices);
      if (slices < info.slices) {
        fail(ErrorCode::kBadFormat, files_[0],
             fmt::format("the description promises {} slices, the file has {}", info.slices, slices));
      }
    } else {
      check_files(progress);
    }
    volume.format = files_.size() == 1 ? "TIFF" : "TIFF slices";
    slices_ = slices;
    volume.size = {page_.width, page_.height, slices};
    volume.type = page_.type;
    volume.spacing_mm = info.spacing_mm;
    volume.warnings.push_back(
        "TIFF carries no orientation: columns are taken to run to the patient's left, rows to posterior, "
        "pages to the "
        "head");
    if (!info.warning.empty()) volume.warnings.push_back(info.warning);
    return header;
  }

  void read_voxels(void* voxels, const Progress& progress) override {
    auto* out = static_cast<unsigned char*>(voxels);
    if (contiguous_) return read_contiguous(out, progress);
    ProgressCounter pages(slices_, progress);
    if (files_.size() > 1) {
      for (const std::filesystem::path& file : files_) {
        read_tiff_page(open_tiff(file).get(), file, page_, out);
        out += page_.bytes();
        pages.add();
      }
      return;
    }
    const TiffFile tiff = open_tiff(files_[0]);
    do {
      if (is_thumbnail(tiff.get())) continue;
      read_tiff_page(tiff.get(), files_[0], page_, out);
      out += page_.bytes();
      pages.add();
    } while (TIFFReadDirectory(tiff.get()));
  }

 private:
  void check_page(TIFF* tiff, const std::filesystem::path& file, std::int64_t index) const {
    const TiffPage page = tiff_page(tiff, file);
    if (page == page_) return;
    fail(ErrorCode::kBadFormat, file,
         fmt::format("slice {} is {}x{} {}; expected {}x{} {} like the first", index, page.width, page.height,
                     voxel_type_name(page.type), page_.width, page_.height, voxel_type_name(page_.type)));
  }

  std::int64_t count_pages(TIFF* tiff) const {
    std::int64_t pages = 0;
    do {
      if (is_thumbnail(tiff) && pages > 0) continue;
      if (is_thumbnail(tiff))
        fail(ErrorCode::kUnsupported, files_[0], "the first page is a thumbnail; expected a slice");
      check_page(tiff, files_[0], pages);
      ++pages;
    } while (TIFFReadDirectory(tiff));
    if (!tiff_message().empty()) {
      fail(ErrorCode::kBadFormat, files_[0],
           fmt::format("the page after page {} is damaged{}", pages, tiff_message()));
    }
    return pages;
  }

  void check_files(const Progress& progress) const {
    ProgressCounter seen(static_cast<std::int64_t>(files_.size()), progress);
    for (std::size_t i = 1; i < files_.size(); ++i) {
      const TiffFile tiff = open_tiff(files_[i]);
      seen.add();
      check_page(tiff.get(), files_[i], static_cast<std::int64_t>(i));
      if (TIFFReadDirectory(tiff.get()) && !is_thumbnail(tiff.get())) {
        fail(ErrorCode::kUnsupported, files_[i],
             "a folder of TIFF files with several pages each; expected one page each");
      }
    }
  }

  /// ImageJ writes stacks beyond 4 GB as one page followed by the raw pixels of all.
  std::int64_t check_contiguous(std::int64_t slices) {
    const TiffFile tiff = open_tiff(files_[0]);
    std::uint16_t compression = COMPRESSION_NONE;
    TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_COMPRESSION, &compression);
    std::uint64_t* offsets = nullptr;
    const bool has_offsets = TIFFGetField(tiff.get(), TIFFTAG_STRIPOFFSETS, &offsets) && offsets;
    if (compression != COMPRESSION_NONE || !has_offsets) {
      fail(ErrorCode::kBadFormat, files_[0],
           fmt::format("the description promises {} slices, the file has 1", slices));
    }
    offset_ = offsets[0];
    swapped_ = TIFFIsByteSwapped(tiff.get()) != 0;
    const std::uint64_t file_bytes = std::filesystem::file_size(files_[0]);
    const std::uint64_t found = file_bytes - std::min(offset_, file_bytes);
    if (found / page_.bytes() < static_cast<std::uint64_t>(slices)) {
      fail(ErrorCode::kBadFormat, files_[0],
           fmt::format("the description promises {} slices of {} bytes, the file has {} bytes of pixels",
                       slices, page_.bytes(), found));
    }
    return slices;
  }

  void read_contiguous(unsigned char* out, const Progress& progress) const {
    const std::uint64_t bytes = page_.bytes() * static_cast<std::uint64_t>(slices_);
    read_plain(files_[0], offset_, out, bytes, progress);
    if (swapped_) swap_bytes(out, bytes / voxel_bytes(page_.type), voxel_bytes(page_.type));
  }

  std::vector<std::filesystem::path> files_;
  TiffPage page_;
  bool contiguous_ = false;
  bool swapped_ = false;
  std::uint64_t offset_ = 0;
  std::int64_t slices_ = 0;
};

}  // namespace

std::unique_ptr<VolumeReader> make_tiff_reader(std::vector<std::filesystem::path> files) {
  return std::make_unique<TiffReader>(std::move(files));
}

}  // namespace voxlume
