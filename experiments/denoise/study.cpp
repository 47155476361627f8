#include "study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "image_io/image_io.h"
#include "metrics/flip.h"
#include "metrics/metrics.h"
#include "tonemap/tone_map.h"

namespace voxlume::study {
namespace fs = std::filesystem;
namespace {

constexpr const char *kFloorDb = "voxlume:floor_db", *kFloorFlip = "voxlume:floor_flip";
/// Seeds of references are those of no frame.
constexpr std::uint32_t kReferenceSeed = 1000000;

}  // namespace

Reference reference(const Options& o, const Sequence& sequence, int frame) {
  const fs::path path = o.folder / "references" / fmt::format("{}-{:04d}.exr", sequence.name(), frame);
  if (fs::exists(path)) {
    Image image = read_image(path);
    const double db = std::stod(image.metadata.at(kFloorDb)), flip = std::stod(image.metadata.at(kFloorFlip));
    return {std::move(image), db, flip};
  }
  const std::uint32_t seed = kReferenceSeed + 2 * static_cast<std::uint32_t>(frame);
  auto [image, half] = sequence.pictures((o.reference_spp + 1) / 2, seed);
  // The mean is half as far from the truth as the halves are from one another, in root mean square.
  const double floor_db = psnr(image, half).value_or(99) + 20 * std::log10(2.0);
  const double floor_flip = flip(image, half).mean;
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = 0.5f * (image.rgba[i] + half.rgba[i]);
  image.metadata[kFloorDb] = fmt::format("{:.4f}", floor_db);
  image.metadata[kFloorFlip] = fmt::format("{:.6f}", floor_flip);
  fs::create_directories(path.parent_path());
  write_exr(image, path);
  return {std::move(image), floor_db, floor_flip};
}

void write_display(const Options& o, const Image& picture, const std::string& name) {
  fs::create_directories(o.folder / "pictures");
  write_png(tone_map(picture), o.folder / "pictures" / (name + ".png"));
}

Table::Table(const Options& options, const std::string& name, const std::string& columns)
    : path_(options.folder / (name + ".csv")), text_(columns + '\n') {}

bool has_table(const Options& options, const std::string& name) {
  return fs::exists(options.folder / (name + ".csv"));
}

void for_each_sequence(const Options& o, const std::string& table,
                       const std::function<void(const Dataset&, const Animation&)>& body) {
  for (const std::string& name : o.data) {
    std::optional<Dataset> data;
    for (const Animation& animation : animations()) {
      const bool chosen =
          o.animations.empty() || std::ranges::find(o.animations, animation.name) != o.animations.end();
      if (!chosen || has_table(o, table + "-" + name + "-" + animation.name)) continue;
      if (!data) data = load_dataset(name, o.environment, o.width, o.height);
      body(*data, animation);
    }
  }
}

void Table::write() const {
  const fs::path aside = path_.string() + ".part";
  std::ofstream(aside) << text_;
  fs::rename(aside, path_);
}

}  // namespace voxlume::study
