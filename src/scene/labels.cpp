#include "scene/labels.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "tonemap/srgb.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kLutEntries = 256;
constexpr std::uintmax_t kMaxTextBytes = 16u << 20;

Vec3f decode(float r, float g, float b) {
  return {linear_from_srgb(r / 255.0f), linear_from_srgb(g / 255.0f), linear_from_srgb(b / 255.0f)};
}

/// Hues a golden angle apart: neighbouring labels are never alike.
Vec3f spread_color(std::size_t label) {
  const float hue = 6.0f * std::fmod(static_cast<float>(label) * 0.61803399f, 1.0f);
  const auto channel = [&](float shift) {
    const float h = std::fmod(hue + shift, 6.0f);
    const float ramp = std::min(std::max(std::abs(h - 3.0f) - 1.0f, 0.0f), 1.0f);
    return 70.0f + 160.0f * ramp;
  };
  return decode(channel(0), channel(4), channel(2));
}

void read_lut(const fs::path& path, LabelTable& table) {
  std::ifstream file(path, std::ios::binary);
  unsigned char bytes[3 * kLutEntries];
  if (!file.read(reinterpret_cast<char*>(bytes), sizeof bytes) || file.peek() != EOF)
    throw Error(ErrorCode::kBadFormat, path.string(), "expected 768 bytes: 256 each of red, green and blue");
  for (std::size_t i = 1; i < std::min(kLutEntries, table.colors.size()); ++i) {
    const Vec3f color = decode(bytes[i], bytes[kLutEntries + i], bytes[2 * kLutEntries + i]);
    if (max_component(color) > 0) table.colors[i] = color;  // black stands for "none given"
  }
}

void read_text(const fs::path& path, LabelTable& table) {
  std::error_code error;
  if (fs::file_size(path, error) > kMaxTextBytes || error)
    throw Error(ErrorCode::kBadFormat, path.string(),
                "expected a text file of label names of at most 16 MiB");
  std::ifstream file(path);
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    std::istringstream fields(line);
    std::string first;
    if (!(fields >> first) || first[0] == '#') continue;
    const auto fail = [&](const std::string& expected) {
      throw Error(ErrorCode::kBadFormat, path.string() + ": line " + std::to_string(number),
                  "expected " + expected);
    };
    if (first.size() > 9 || first.find_first_not_of("0123456789") != std::string::npos)
      fail("a label value, as in \"12 Hippocampus_L\"");
    const std::size_t label = std::stoul(first);
    std::string name;
    fields >> name;
    if (label >= table.names.size()) continue;
    table.names[label] = name;
    float r, g, b;
    if (!(fields >> r >> g >> b)) continue;  // what follows a name may be something else (a region code)
    if (!(r >= 0 && r <= 255 && g >= 0 && g <= 255 && b >= 0 && b <= 255)) fail("colours from 0 to 255");
    if (label > 0) table.colors[label] = decode(r, g, b);
  }
}

/// Names a file beside the volume may have: aal.nii.gz -> aal.nii.gz.txt, aal.nii.txt, aal.txt.
std::vector<fs::path> companions(const fs::path& volume, const std::string& ending) {
  std::vector<fs::path> out{volume.string() + ending};
  for (fs::path stem = volume; stem.has_extension();) {
    stem.replace_extension();
    out.push_back(stem.string() + ending);
  }
  return out;
}

}  // namespace

std::vector<fs::path> label_files_beside(const fs::path& volume_path) {
  std::vector<fs::path> out;
  for (const char* ending : {".lut", ".txt"}) {
    const std::vector<fs::path> names = companions(volume_path, ending);
    std::error_code failed;
    const auto found = std::find_if(names.begin(), names.end(),
                                    [&](const fs::path& path) { return fs::is_regular_file(path, failed); });
    if (found != names.end()) out.push_back(*found);
  }
  return out;
}

LabelTable read_label_table(const fs::path& volume_path, const fs::path& names_path, std::size_t count) {
  LabelTable table;
  table.names.resize(count);
  table.colors.assign(count, Vec3f(-1));
  const auto read = [&](const fs::path& path) {
    path.extension() == ".lut" ? read_lut(path, table) : read_text(path, table);
  };
  if (!names_path.empty()) {
    if (!fs::is_regular_file(names_path))
      throw Error(ErrorCode::kFileNotFound, names_path.string(), "no such file of label names");
    read(names_path);
  } else {
    for (const fs::path& path : label_files_beside(volume_path)) read(path);
  }
  for (std::size_t i = 1; i < count; ++i)
    if (table.colors[i].x < 0) table.colors[i] = spread_color(i);
  return table;
}

}  // namespace voxlume
