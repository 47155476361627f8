#include "image_io/picture_text.h"

#include <array>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "base/fail.h"

namespace voxlume {
namespace {

constexpr std::uint32_t kMaxTextBytes = 1u << 20;

/// Fewer bytes where the file ends before.
std::string read_bytes(std::ifstream& file, std::uint32_t count) {
  std::string bytes(count, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(count));
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

std::uint32_t read_u32(std::ifstream& file, bool big_endian) {
  std::array<unsigned char, 4> b{};
  file.read(reinterpret_cast<char*>(b.data()), b.size());
  const auto byte = [&](std::size_t i) { return std::uint32_t{b[big_endian ? 3 - i : i]}; };
  return byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
}

/// Chunks: byte count, type, data, checksum. Texts are keyword, zero byte, text; ours come before the pixels.
std::string png_text(std::ifstream& file, const std::string& name) {
  const std::string start = name + '\0';
  while (file) {
    const std::uint32_t count = read_u32(file, true);
    const std::string type = read_bytes(file, 4);
    if (!file || type == "IDAT" || type == "IEND") break;
    if (type == "tEXt" && count <= kMaxTextBytes) {
      const std::string data = read_bytes(file, count);
      if (file && data.starts_with(start)) return data.substr(start.size());
      file.seekg(4, std::ios::cur);
    } else {
      file.seekg(std::int64_t{count} + 4, std::ios::cur);
    }
  }
  return "";
}

/// Attributes: name, type (both end in a zero byte), byte count, value; an empty name ends the header.
std::string exr_text(std::ifstream& file, const std::string& name) {
  file.seekg(4, std::ios::cur);  // version and flags
  while (file) {
    std::string found, type;
    std::getline(file, found, '\0');
    if (!file || found.empty()) break;
    std::getline(file, type, '\0');
    const std::uint32_t count = read_u32(file, false);
    if (found == name && type == "string" && count <= kMaxTextBytes) {
      const std::string text = read_bytes(file, count);
      return file ? text : "";
    }
    file.seekg(count, std::ios::cur);
  }
  return "";
}

}  // namespace

std::string picture_text(const std::filesystem::path& path, const std::string& name) {
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(ErrorCode::kFileNotFound, path, "cannot be read");
  const std::string magic = read_bytes(file, 4);
  if (magic == "\x76\x2f\x31\x01") return exr_text(file, name);
  if (magic == "\x89PNG" && read_bytes(file, 4) == "\r\n\x1a\n") return png_text(file, name);
  return "";
}

}  // namespace voxlume
