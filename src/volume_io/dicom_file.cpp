#include "volume_io/dicom_file.h"

#include <fmt/format.h>
#include <gdcmDataSet.h>
#include <gdcmImageReader.h>
#include <gdcmReader.h>
#include <gdcmSequenceOfItems.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "base/fail.h"

namespace voxlume {
namespace {

using gdcm::DataSet;
using gdcm::Tag;

std::string text_of(const DataSet& data, const Tag& tag) {
  if (!data.FindDataElement(tag)) return {};
  const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
  if (!bytes) return {};
  std::string text(bytes->GetPointer(), bytes->GetLength());
  const auto is_padding = [](char c) { return c == ' ' || c == '\0'; };
  while (!text.empty() && is_padding(text.back())) text.pop_back();
  while (!text.empty() && is_padding(text.front())) text.erase(text.begin());
  return text;
}

/// The decimal numbers of a value like "0.5\0.5"; empty when there are not `count` finite ones.
std::vector<double> numbers_of(const DataSet& data, const Tag& tag, std::size_t count) {
  const std::string text = text_of(data, tag);
  std::vector<double> numbers;
  const char* at = text.data();
  const char* end = text.data() + text.size();
  while (numbers.size() < count) {
    while (at != end && (*at == ' ' || *at == '+')) ++at;
    double value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value)) return {};
    numbers.push_back(value);
    at = next;
    while (at != end && *at != '\\') ++at;
    if (at != end) ++at;
  }
  return numbers;
}

double number_of(const DataSet& data, const Tag& tag, double otherwise) {
  const std::vector<double> numbers = numbers_of(data, tag, 1);
  return numbers.empty() ? otherwise : numbers[0];
}

/// A whole number written as text, kept within int.
int count_of(const DataSet& data, const Tag& tag, int otherwise) {
  return static_cast<int>(std::clamp(number_of(data, tag, otherwise), -1e9, 1e9));
}

/// An unsigned 16-bit binary value.
int word_of(const DataSet& data, const Tag& tag, int otherwise) {
  if (!data.FindDataElement(tag)) return otherwise;
  const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
  if (!bytes || bytes->GetLength() < 2) return otherwise;
  const auto* p = reinterpret_cast<const unsigned char*>(bytes->GetPointer());
  return p[0] | (p[1] << 8);
}

/// The first item of a sequence that has one.
const DataSet* first_item(const DataSet& data, const Tag& tag,
                          gdcm::SmartPointer<gdcm::SequenceOfItems>& owner) {
  if (!data.FindDataElement(tag)) return nullptr;
  owner = data.GetDataElement(tag).GetValueAsSQ();
  return owner && owner->GetNumberOfItems() > 0 ? &owner->GetItem(1).GetNestedDataSet() : nullptr;
}

void read_plane(const DataSet& data, DicomFrame& frame) {
  if (const auto p = numbers_of(data, {0x0020, 0x0032}, 3); !p.empty())
    frame.position_mm = {p[0], p[1], p[2]};
  if (const auto o = numbers_of(data, {0x0020, 0x0037}, 6); !o.empty()) {
    frame.orientation = {o[0], o[1], o[2], o[3], o[4], o[5]};
  }
  // PixelSpacing is written row spacing first: that is along a column.
  if (const auto s = numbers_of(data, {0x0028, 0x0030}, 2); !s.empty()) frame.pixel_mm = {s[1], s[0]};
  frame.slope = number_of(data, {0x0028, 0x1053}, frame.slope);
  frame.intercept = number_of(data, {0x0028, 0x1052}, frame.intercept);
}

double slice_step(const DataSet& data, double otherwise) {
  return std::abs(number_of(data, {0x0018, 0x0088}, number_of(data, {0x0018, 0x0050}, otherwise)));
}

/// The functional groups of an enhanced multi-frame file: PlanePosition, PlaneOrientation, PixelMeasures and
/// PixelValueTransformation, each a sequence of one item.
void read_groups(const DataSet& data, DicomFrame& frame, double& step_mm) {
  for (const Tag& tag :
       {Tag(0x0020, 0x9113), Tag(0x0020, 0x9116), Tag(0x0028, 0x9110), Tag(0x0028, 0x9145)}) {
    gdcm::SmartPointer<gdcm::SequenceOfItems> owner;
    if (const DataSet* item = first_item(data, tag, owner)) {
      read_plane(*item, frame);
      step_mm = slice_step(*item, step_mm);
    }
  }
}

void read_frames(const DataSet& data, DicomFile& file) {
  constexpr int kMaxFrames = 1 << 20;
  const int count = count_of(data, {0x0028, 0x0008}, 1);
  DicomFrame shared;
  read_plane(data, shared);
  if (shared.pixel_mm[0] == 0) {
    if (const auto s = numbers_of(data, {0x0018, 0x1164}, 2); !s.empty()) shared.pixel_mm = {s[1], s[0]};
  }
  if (count <= 1) {
    file.frames = {shared};
    return;
  }
  shared.position_mm.reset();  // one position cannot be that of every frame
  gdcm::SmartPointer<gdcm::SequenceOfItems> owner;
  if (const DataSet* item = first_item(data, {0x5200, 0x9229}, owner))
    read_groups(*item, shared, file.slice_step_mm);
  file.frames.assign(static_cast<std::size_t>(std::min(count, kMaxFrames)), shared);
  const Tag per_frame(0x5200, 0x9230);
  if (!data.FindDataElement(per_frame)) return;
  const auto groups = data.GetDataElement(per_frame).GetValueAsSQ();
  const std::size_t items = groups ? groups->GetNumberOfItems() : 0;
  for (std::size_t i = 0; i < std::min(items, file.frames.size()); ++i) {
    read_groups(groups->GetItem(i + 1).GetNestedDataSet(), file.frames[i], file.slice_step_mm);
  }
}

std::string modality_of(const DataSet& data) {
  const std::string text = text_of(data, {0x0008, 0x0060});
  const bool plain = std::all_of(text.begin(), text.end(), [](char c) { return c >= 'A' && c <= 'Z'; });
  return plain && text.size() >= 2 && text.size() <= 8 ? text : "";
}

/// A file buffer that notices when a value is cut short, which gdcm pads with zeros.
class WatchedFile : public std::filebuf {
 public:
  bool cut_short() const { return cut_short_; }

 protected:
  std::streamsize xsgetn(char* to, std::streamsize count) override {
    constexpr std::streamsize kTagBytes = 4;  // looking for a next tag at the end of the file is no fault
    const std::streamsize got = std::filebuf::xsgetn(to, count);
    if (got < count && (got > 0 || count > kTagBytes)) cut_short_ = true;
    return got;
  }

 private:
  bool cut_short_ = false;
};

const std::set<Tag>& structural_tags() {
  static const std::set<Tag> kTags = {{0x0008, 0x0016}, {0x0008, 0x0060}, {0x0018, 0x0050}, {0x0018, 0x0088},
                                      {0x0018, 0x1120}, {0x0018, 0x1164}, {0x0020, 0x000e}, {0x0020, 0x0011},
                                      {0x0020, 0x0013}, {0x0020, 0x0032}, {0x0020, 0x0037}, {0x0028, 0x0002},
                                      {0x0028, 0x0004}, {0x0028, 0x0008}, {0x0028, 0x0010}, {0x0028, 0x0011},
                                      {0x0028, 0x0030}, {0x0028, 0x0100}, {0x0028, 0x0101}, {0x0028, 0x0103},
                                      {0x0028, 0x1052}, {0x0028, 0x1053}, {0x5200, 0x9229}, {0x5200, 0x9230}};
  return kTags;
}

}  // namespace

std::optional<DicomFile> read_dicom_tags(const std::filesystem::path& path) {
  gdcm::Reader reader;
  reader.SetFileName(path.c_str());
  try {
    if (!reader.ReadSelectedTags(structural_tags())) return std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;
  }
  const DataSet& data = reader.GetFile().GetDataSet();
  DicomFile file;
  file.path = path;
  file.rows = word_of(data, {0x0028, 0x0010}, 0);
  file.columns = word_of(data, {0x0028, 0x0011}, 0);
  if (file.rows < 1 || file.columns < 1) return std::nullopt;
  file.series_uid = text_of(data, {0x0020, 0x000e});
  file.modality = modality_of(data);
  file.series_number = count_of(data, {0x0020, 0x0011}, 0);
  file.instance_number = count_of(data, {0x0020, 0x0013}, 0);
  file.samples = word_of(data, {0x0028, 0x0002}, 1);
  file.bits_allocated = word_of(data, {0x0028, 0x0100}, 16);
  file.bits_stored = word_of(data, {0x0028, 0x0101}, file.bits_allocated);
  file.is_signed = word_of(data, {0x0028, 0x0103}, 0) == 1;
  const std::string photometric = text_of(data, {0x0028, 0x0004});
  file.inverted = photometric == "MONOCHROME1";
  file.palette = photometric == "PALETTE COLOR";
  file.tilt_degrees = number_of(data, {0x0018, 0x1120}, 0);
  file.slice_step_mm = slice_step(data, 0);
  read_frames(data, file);
  return file;
}

std::vector<char> read_dicom_pixels(const DicomFile& file) {
  WatchedFile watched;
  if (!watched.open(file.path, std::ios::in | std::ios::binary)) {
    fail(ErrorCode::kFileNotFound, file.path, "cannot open this file for reading");
  }
  std::istream stream(&watched);
  gdcm::ImageReader reader;
  reader.SetStream(stream);
  const bool is_read = reader.Read();
  if (watched.cut_short()) fail(ErrorCode::kBadFormat, file.path, "the DICOM file is cut short");
  if (!is_read) fail(ErrorCode::kBadFormat, file.path, "the DICOM pixels cannot be read (damaged?)");
  const gdcm::Image& image = reader.GetImage();
  const std::uint64_t expected = std::uint64_t{static_cast<unsigned>(file.columns)} *
                                 static_cast<unsigned>(file.rows) * file.frames.size() *
                                 static_cast<unsigned>(file.bits_allocated / 8);
  const std::uint64_t found = image.GetBufferLength();
  if (found != expected || image.GetPixelFormat().GetBitsAllocated() != file.bits_allocated) {
    fail(ErrorCode::kBadFormat, file.path,
         fmt::format("the DICOM pixels take {} bytes; the tags promise {}", found, expected));
  }
  const gdcm::ByteValue* plain = image.GetDataElement().GetByteValue();
  if (plain && !image.GetTransferSyntax().IsEncapsulated() && plain->GetLength() < expected) {
    fail(
        ErrorCode::kBadFormat, file.path,
        fmt::format("expected {} bytes of pixels, file has {}", expected, std::uint64_t{plain->GetLength()}));
  }
  std::vector<char> pixels(expected);
  if (!image.GetBuffer(pixels.data())) {
    fail(ErrorCode::kBadFormat, file.path,
         "the DICOM pixels cannot be decoded (damaged, or an unknown compression)");
  }
  return pixels;
}

bool looks_like_dicom(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 132> start{};
  file.read(start.data(), start.size());
  const std::string_view bytes(start.data(), static_cast<std::size_t>(file.gcount()));
  if (bytes.size() == start.size() && bytes.substr(128) == "DICM") return true;
  // Without the preamble: the first tag is of group 0002 or 0008, little-endian.
  return bytes.size() > 8 && (bytes[0] == 2 || bytes[0] == 8) && bytes[1] == 0 && bytes[3] == 0;
}

}  // namespace voxlume
