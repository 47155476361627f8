#include "film/film.h"

#include <atomic>
#include <cmath>
#include <new>
#include <string>
#include <utility>

#include "voxlume/error.h"

namespace voxlume {
namespace {

constexpr int kMaxSide = 65536;

// Zero instead of a value that is not finite; says whether that happened.
bool clear_nonfinite(Vec3d& v) noexcept {
  if (is_finite(v)) return false;
  v = Vec3d(0);
  return true;
}

template <class Element>
std::span<const std::byte> bytes_of(const std::vector<Element>& values) {
  return std::as_bytes(std::span<const Element>(values));
}

}  // namespace

Film::Film(int width, int height, FilmLayers layers) : width_(width), height_(height), layers_(layers) {
  const auto size_text = [&] { return std::to_string(width) + " x " + std::to_string(height); };
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
    throw Error(ErrorCode::kBadParameter, "",
                "picture size " + size_text() + "; expected 1 to " + std::to_string(kMaxSide) + " each way");
  }
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  try {
    sums_.resize(pixels);
    counts_.resize(pixels);
    if (layers.depth) depths_.resize(pixels);
    if (layers.normal) normals_.resize(pixels);
    if (layers.albedo) albedos_.resize(pixels);
    if (layers.classes) classes_.resize(pixels);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::kOutOfMemory, "",
                "a picture of " + size_text() + " needs " +
                    std::to_string((pixels * bytes_per_pixel(layers)) >> 20) + " MiB; render it smaller");
  }
}

void Film::add(int x, int y, const PixelSample& sample) noexcept {
  const std::size_t i = index(x, y);
  Vec3d radiance(sample.radiance);
  bool nonfinite = clear_nonfinite(radiance);
  Sums& sums = sums_[i];
  const double y_luminance = luminance(radiance);
  sums.radiance += radiance;
  sums.luminance_squared += y_luminance * y_luminance;
  if (layers_.classes && counts_[i] == 0 && sample.alpha > 0 && !nonfinite &&
      std::isfinite(sample.depth_mm)) {
    classes_[i].first_luminance = luminance(sample.radiance);
    classes_[i].first_depth_mm = sample.depth_mm;
  }
  if (++counts_[i] % kBlock == 0) {
    const double total = luminance(sums.radiance), block = total - sums.block_luminance;
    sums.block_squares += block * block;
    sums.block_luminance = total;
  }

  double alpha = sample.alpha;
  if (!std::isfinite(alpha)) {
    alpha = 0;
    nonfinite = true;
  }
  if (alpha != 0) {
    sums.alpha += alpha;
    if (layers_.depth) {
      Vec3d depth(sample.depth_mm, 0.0, 0.0);
      nonfinite |= clear_nonfinite(depth);
      depths_[i] += alpha * depth.x;
    }
    if (layers_.normal) {
      Vec3d normal(sample.normal);
      nonfinite |= clear_nonfinite(normal);
      normals_[i] += alpha * normal;
    }
    if (layers_.albedo) {
      Vec3d albedo(sample.albedo);
      nonfinite |= clear_nonfinite(albedo);
      albedos_[i] += alpha * albedo;
    }
  }
  if (nonfinite) std::atomic_ref(nonfinite_samples_).fetch_add(1, std::memory_order_relaxed);
}

Vec3d Film::mean_at(std::size_t i) const noexcept {
  return counts_[i] == 0 ? Vec3d(0) : sums_[i].radiance / static_cast<double>(counts_[i]);
}

double Film::variance_of_mean_at(std::size_t i) const noexcept {
  const double n = counts_[i];
  if (n < 2) return 0;
  const double sum = luminance(sums_[i].radiance);
  const double variance = (sums_[i].luminance_squared - sum * sum / n) / (n - 1);
  return variance > 0 ? variance / n : 0;  // rounding leaves equal samples slightly below zero
}

Vec3d Film::mean(int x, int y) const noexcept { return mean_at(index(x, y)); }

double Film::alpha(int x, int y) const noexcept {
  const std::size_t i = index(x, y);
  return counts_[i] == 0 ? 0 : sums_[i].alpha / counts_[i];
}

double Film::variance_of_mean(int x, int y) const noexcept { return variance_of_mean_at(index(x, y)); }

double Film::standard_error(int x, int y) const noexcept { return std::sqrt(variance_of_mean(x, y)); }

Vec3d Film::albedo(int x, int y) const noexcept {
  const std::size_t i = index(x, y);
  return layers_.albedo && sums_[i].alpha > 0 ? albedos_[i] / sums_[i].alpha : Vec3d(0);
}

Vec3d Film::normal(int x, int y) const noexcept {
  const std::size_t i = index(x, y);
  return layers_.normal && sums_[i].alpha > 0 ? normals_[i] / sums_[i].alpha : Vec3d(0);
}

double Film::depth_mm(int x, int y) const noexcept {
  const std::size_t i = index(x, y);
  return layers_.depth && sums_[i].alpha > 0 ? depths_[i] / sums_[i].alpha : 0;
}

double Film::noise() const noexcept {
  const std::vector<float> shares = variance_shares();
  double sum = 0;
  for (std::size_t i = 0; i < pixel_count(); ++i) {
    sum += std::sqrt(shares[i] * variance_of_mean_at(i)) / (luminance(mean_at(i)) + 0.01);
  }
  return sum / static_cast<double>(pixel_count());
}

double Film::mean_luminance() const noexcept {
  double sum = 0;
  for (std::size_t i = 0; i < pixel_count(); ++i) sum += luminance(mean_at(i));
  return sum / static_cast<double>(pixel_count());
}

std::uint64_t Film::total_samples() const noexcept {
  std::uint64_t total = 0;
  for (const std::uint32_t count : counts_) total += count;
  return total;
}

std::size_t Film::bytes_per_pixel(FilmLayers layers) noexcept {
  return sizeof(Sums) + sizeof(std::uint32_t) + (layers.depth ? sizeof(double) : 0) +
         (layers.normal ? sizeof(Vec3d) : 0) + (layers.albedo ? sizeof(Vec3d) : 0) +
         (layers.classes ? sizeof(PixelClasses) : 0);
}

std::vector<std::span<const std::byte>> Film::accumulators() const {
  return {bytes_of(sums_),
          bytes_of(counts_),
          bytes_of(depths_),
          bytes_of(normals_),
          bytes_of(albedos_),
          bytes_of(classes_),
          std::as_bytes(std::span(&nonfinite_samples_, 1))};
}

std::vector<std::span<std::byte>> Film::accumulators() {
  std::vector<std::span<std::byte>> writable;
  for (const std::span<const std::byte> bytes : std::as_const(*this).accumulators()) {
    writable.emplace_back(const_cast<std::byte*>(bytes.data()), bytes.size());
  }
  return writable;
}

}  // namespace voxlume
