#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>
#include <vector>

#include "base/fail.h"
#include "voxlume/volume_io.h"

namespace voxlume {
namespace {

constexpr std::string_view kForm = "WxHxD,type,sx,sy,sz[,little|big][,offset]";

[[noreturn]] void fail_field(std::string_view field, std::string_view found, std::string_view expected) {
  fail(ErrorCode::kBadParameter, "",
       fmt::format("raw {} \"{}\"; expected {} (the form is {})", field, found.substr(0, 60), expected,
                   kForm));
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

template <typename T>
bool parse_number(std::string_view text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

std::array<std::int64_t, 3> parse_size(std::string_view text) {
  const std::vector<std::string_view> parts = split(text, 'x');
  std::array<std::int64_t, 3> size{};
  if (parts.size() != 3) fail_field("size", text, "three numbers like 256x256x108");
  double voxels = 1;
  for (int a = 0; a < 3; ++a) {
    if (!parse_number(parts[a], size[a]) || size[a] < 1)
      fail_field("size", text, "three whole numbers above 0");
    voxels *= static_cast<double>(size[a]);
  }
  if (voxels > 0x1p56) fail_field("size", text, "a volume that can exist");
  return size;
}

}  // namespace

RawSpec parse_raw_spec(std::string_view text) {
  const std::vector<std::string_view> fields = split(text, ',');
  RawSpec spec;
  if (fields.size() < 5 || fields.size() > 7)
    fail_field("specification", text, "5 to 7 fields with commas between");
  spec.size = parse_size(fields[0]);
  try {
    spec.type = parse_voxel_type(fields[1]);
  } catch (const Error&) {
    fail_field("type", fields[1], "u8, i8, u16, i16, u32, i32, f32 or f64");
  }
  for (int a = 0; a < 3; ++a) {
    double& s = spec.spacing_mm[a];
    if (!parse_number(fields[2 + a], s) || !std::isfinite(s) || s <= 0) {
      fail_field("spacing", fields[2 + a], "a number above 0 (mm)");
    }
  }
  bool has_endian = false;
  bool has_offset = false;
  for (std::size_t i = 5; i < fields.size(); ++i) {
    if (!has_endian && !has_offset && (fields[i] == "little" || fields[i] == "big")) {
      has_endian = true;
      spec.big_endian = fields[i] == "big";
    } else if (!has_offset && parse_number(fields[i], spec.offset_bytes) &&
               spec.offset_bytes < (1ull << 60)) {
      has_offset = true;
    } else {
      fail_field(i == 5 ? "byte order or offset" : "offset", fields[i],
                 i == 5 ? "little, big or a number of bytes" : "a number of bytes");
    }
  }
  return spec;
}

}  // namespace voxlume
