#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

namespace voxlume {

/// Begins blocks at different places of a page. Filters read the same pixel of many planes; if all planes
/// began alike, as large blocks do, those values would compete for the same few lines of the first cache.
template <class T>
struct SpreadAllocator {
  using value_type = T;
  static constexpr std::size_t kPage = 4096, kPlaces = 16;

  SpreadAllocator() = default;
  template <class U>
  SpreadAllocator(const SpreadAllocator<U>&) noexcept {}

  T* allocate(std::size_t count) {
    static std::atomic<std::size_t> blocks{0};
    const std::size_t place = blocks.fetch_add(5, std::memory_order_relaxed) % kPlaces;
    auto* page = static_cast<std::byte*>(::operator new(count * sizeof(T) + kPage, std::align_val_t(kPage)));
    return reinterpret_cast<T*>(page + place * (kPage / kPlaces));
  }
  void deallocate(T* block, std::size_t) noexcept {
    const std::size_t place = reinterpret_cast<std::uintptr_t>(block) % kPage;
    ::operator delete(reinterpret_cast<std::byte*>(block) - place, std::align_val_t(kPage));
  }
  friend bool operator==(SpreadAllocator, SpreadAllocator) { return true; }
};

/// One float for each pixel. Around the picture lies a border of zeros that can be read but is not written:
/// filters take neighbours from it without asking where the picture ends, and weight them by a plane that is
/// zero there (alpha).
class Plane {
 public:
  /// How far beyond the picture rows and columns can be read. A vector that begins there may end beyond; it
  /// reads what follows in memory.
  static constexpr int kBorder = 32;

  Plane() = default;
  /// Zeros. width, height >= 1.
  Plane(int width, int height)
      : width_(width),
        height_(height),
        stride_(width + 2 * kBorder),
        values_(static_cast<std::size_t>(stride_) * (height + 2 * kBorder) + kBorder) {}

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  /// Values from one row to the next.
  int stride() const noexcept { return stride_; }

  /// Row y in [-kBorder, height + kBorder); its columns are [-kBorder, width + kBorder).
  float* row(int y) noexcept { return values_.data() + offset(y); }
  const float* row(int y) const noexcept { return values_.data() + offset(y); }
  float& at(int x, int y) noexcept { return row(y)[x]; }
  float at(int x, int y) const noexcept { return row(y)[x]; }

  /// Sets the picture, not its border.
  void fill(float value) noexcept {
    for (int y = 0; y < height_; ++y) std::fill_n(row(y), width_, value);
  }

 private:
  std::ptrdiff_t offset(int y) const noexcept {
    return static_cast<std::ptrdiff_t>(y + kBorder) * stride_ + kBorder;
  }

  int width_ = 0, height_ = 0, stride_ = 0;
  std::vector<float, SpreadAllocator<float>> values_;
};

/// Red, green and blue, or x, y and z.
using Planes3 = std::array<Plane, 3>;

inline Planes3 make_planes3(int width, int height) {
  return {Plane(width, height), Plane(width, height), Plane(width, height)};
}

}  // namespace voxlume
