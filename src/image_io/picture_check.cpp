#include "image_io/picture_check.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <string>
#include <string_view>

#include "base/fail.h"
#include "base/memory.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxSide = 65536;
constexpr std::int64_t kMaxChannels = 1024;
// No format packs values tighter; a file that claims so is damaged.
constexpr std::uint64_t kMaxValuesPerByte = 65536;
constexpr std::size_t kMaxNameBytes = 255;  // of an OpenEXR attribute

// One attribute of an OpenEXR header: name, type (both end in a zero byte), byte count, value.
enum class ExrAttribute { kRead, kEndOfHeader, kBad };

// Moves past the next attribute.
ExrAttribute skip_attribute(std::ifstream& file, std::uint64_t file_bytes) {
  std::string name, type;
  std::getline(file, name, '\0');
  if (!file || name.size() > kMaxNameBytes) return ExrAttribute::kBad;
  if (name.empty()) return ExrAttribute::kEndOfHeader;
  std::getline(file, type, '\0');
  std::array<unsigned char, 4> count{};
  file.read(reinterpret_cast<char*>(count.data()), count.size());
  if (!file || type.size() > kMaxNameBytes) return ExrAttribute::kBad;
  const std::uint64_t value_bytes = count[0] | count[1] << 8 | count[2] << 16 | std::uint64_t{count[3]} << 24;
  const std::uint64_t at = static_cast<std::uint64_t>(file.tellg());
  if (value_bytes > file_bytes - at) return ExrAttribute::kBad;
  file.seekg(static_cast<std::streamoff>(value_bytes), std::ios::cur);
  return ExrAttribute::kRead;
}

}  // namespace

PictureFormat picture_format(const fs::path& path) {
  std::array<char, 8> bytes{};
  std::error_code failed;
  std::ifstream file(path, std::ios::binary);
  if (!file || fs::is_directory(path, failed)) {
    fail(ErrorCode::kFileNotFound, path, "cannot be read; expected an EXR, HDR or PNG picture");
  }
  file.read(bytes.data(), bytes.size());
  const std::string_view start(bytes.data(), static_cast<std::size_t>(file.gcount()));
  if (start.starts_with("\x76\x2f\x31\x01")) return PictureFormat::kExr;
  if (start.starts_with("#?")) return PictureFormat::kHdr;
  if (start.starts_with("\x89PNG\r\n\x1a\n")) return PictureFormat::kPng;
  fail(ErrorCode::kBadFormat, path, "does not begin as an EXR, HDR or PNG picture does");
}

void check_picture_size(const fs::path& path, std::int64_t width, std::int64_t height, std::int64_t channels,
                        const ImageReadOptions& options) {
  const std::string size = fmt::format("{} x {} x {} channels", width, height, channels);
  if (width < 1 || height < 1 || channels < 1 || width > kMaxSide || height > kMaxSide ||
      channels > kMaxChannels) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("is {}; expected 1 to {} each way and at most {} channels", size, kMaxSide,
                     kMaxChannels));
  }
  const std::uint64_t pixels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  const std::uint64_t file_bytes = fs::file_size(path);
  if (pixels * static_cast<std::uint64_t>(channels) > file_bytes * kMaxValuesPerByte) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("says it is {}, which {} bytes cannot hold", size, file_bytes));
  }
  // The values as decoded, and the same again sorted into colour and layers.
  const std::uint64_t bytes = pixels * (2 * static_cast<std::uint64_t>(channels) + 4) * sizeof(float);
  const std::uint64_t limit =
      options.memory_limit_bytes > 0 ? options.memory_limit_bytes : available_memory_bytes();
  if (bytes > limit) {
    fail(ErrorCode::kOutOfMemory, path,
         fmt::format("is {} and needs {} MiB; {} MiB are available", size, bytes >> 20, limit >> 20));
  }
}

void check_exr_header(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::uint64_t file_bytes = fs::file_size(path);
  std::array<unsigned char, 8> start{};  // magic and version
  file.read(reinterpret_cast<char*>(start.data()), start.size());
  const bool multi_part = (start[5] & 0x10) != 0;
  for (bool in_header = false;;) {
    const ExrAttribute attribute = skip_attribute(file, file_bytes);
    if (attribute == ExrAttribute::kBad) fail(ErrorCode::kBadFormat, path, "has a damaged OpenEXR header");
    if (attribute == ExrAttribute::kEndOfHeader) {
      // Several parts have a header each, and an empty one at the end.
      if (!multi_part || !in_header) return;
    }
    in_header = attribute == ExrAttribute::kRead;
  }
}

}  // namespace voxlume
