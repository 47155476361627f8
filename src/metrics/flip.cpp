#include "metrics/flip.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>

#include "base/parallel.h"
#include "metrics/flip_color.h"
#include "metrics/flip_filters.h"
#include "metrics/pixel_values.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

// Symbols and values of Andersson et al. 2020, sections 4.1.4 to 4.3.
constexpr float kColorExponent = 0.7f;    // q_c; that of features, q_f, is 1/2
constexpr float kColorKnee = 0.4f;        // p_c, share of the largest colour difference
constexpr float kErrorAtKnee = 0.95f;     // p_t
constexpr double kBrightestShown = 0.85;  // of HDR-FLIP: what the tone curve makes of it at start_ev
constexpr int kTilePixels = kFlipTile * kFlipTile;

float color_distance(Vec3f lab, Vec3f other) { return std::pow(hyab(lab, other), kColorExponent); }

float largest_color_distance() {
  const Vec3f green = hunt_lab_from_xyz(xyz_from_rgb({0, 1, 0}));
  const Vec3f blue = hunt_lab_from_xyz(xyz_from_rgb({0, 0, 1}));
  return color_distance(green, blue);
}

Vec3f clamped(Vec3f rgb) {
  return {std::clamp(rgb.x, 0.0f, 1.0f), std::clamp(rgb.y, 0.0f, 1.0f), std::clamp(rgb.z, 0.0f, 1.0f)};
}

// A pixel as a display shows it: linear, in [0,1].
Vec3f shown(const float* rgb) { return clamped({rgb[0], rgb[1], rgb[2]}); }
Vec3f shown_exposed(const float* rgb, float scale) {
  const auto develop = [scale](float linear) { return flip_tone_curve(std::max(linear, 0.0f) * scale); };
  return {develop(rgb[0]), develop(rgb[1]), develop(rgb[2])};
}

// What a tile of one picture looks like. Every array holds the tile's pixels row by row.
struct TileLook {
  std::vector<Vec3f> lab = std::vector<Vec3f>(kTilePixels);  // as the eye blurs it
  std::vector<float> edge = std::vector<float>(kTilePixels);
  std::vector<float> point = std::vector<float>(kTilePixels);  // size of the features, times 116
};

// Compares tiles, one at a time; the buffers are its own.
class TileComparison {
 public:
  TileComparison(const FlipFilters& filters, float largest_distance)
      : filters_(filters),
        largest_distance_(largest_distance),
        stride_(kFlipTile + 2 * filters.radius),
        opponent_{plane(stride_), plane(stride_), plane(stride_)},
        along_x_{plane(kFlipTile), plane(kFlipTile), plane(kFlipTile)} {
    for (std::vector<float>& values : along_y_) values.resize(kTilePixels);
  }

  // What the tile at (x, y) looks like, developed by develop(rgb).
  template <class Develop>
  void look_at(const Image& image, int x, int y, Develop develop, TileLook& look) {
    load(image, x, y, develop);
    blur(look);
    find_features(look);
  }

  // Raises the error of every pixel of the tile at (x, y) to that between the two pictures, developed by
  // develop(rgb).
  template <class Develop>
  void compare(const Image& image, const Image& reference, int x, int y, Develop develop, float* error_map) {
    look_at(reference, x, y, develop, reference_look_);
    compare(image, reference_look_, x, y, develop, error_map);
  }
  template <class Develop>
  void compare(const Image& image, const TileLook& reference, int x, int y, Develop develop,
               float* error_map) {
    look_at(image, x, y, develop, look_);
    const int columns = std::min(kFlipTile, image.width - x), rows = std::min(kFlipTile, image.height - y);
    for (int row = 0; row < rows; ++row) {
      float* out = error_map + static_cast<std::size_t>(y + row) * image.width + x;
      for (int column = 0; column < columns; ++column) {
        out[column] = std::max(out[column], error_at(reference, row * kFlipTile + column));
      }
    }
  }

 private:
  std::vector<float> plane(int width) const {
    return std::vector<float>(static_cast<std::size_t>(width) * stride_);
  }

  // The tile and its margin. Beyond the border the picture goes on as its last pixel.
  template <class Develop>
  void load(const Image& image, int x0, int y0, Develop develop) {
    std::size_t i = 0;
    for (int row = 0; row < stride_; ++row) {
      const int y = std::clamp(y0 - filters_.radius + row, 0, image.height - 1);
      for (int column = 0; column < stride_; ++column, ++i) {
        const int x = std::clamp(x0 - filters_.radius + column, 0, image.width - 1);
        const Vec3f opponent = opponent_from_xyz(xyz_from_rgb(develop(image.pixel(x, y))));
        for (int c = 0; c < 3; ++c) opponent_[c][i] = opponent[c];
      }
    }
  }

  void filter_x(const std::vector<float>& in, const FlipKernel& kernel, std::vector<float>& out) const {
    apply_flip_kernel(in.data() + filters_.radius, stride_, 1, kernel, stride_, out.data());
  }
  void filter_y(const std::vector<float>& in, const FlipKernel& kernel, std::vector<float>& out) const {
    const float* first = in.data() + static_cast<std::size_t>(filters_.radius) * kFlipTile;
    apply_flip_kernel(first, kFlipTile, kFlipTile, kernel, kFlipTile, out.data());
  }
  void filter(const std::vector<float>& in, const FlipKernel& kernel, std::vector<float>& out) {
    filter_x(in, kernel, along_x_[0]);
    filter_y(along_x_[0], kernel, out);
  }

  void blur(TileLook& look) {
    filter(opponent_[0], filters_.achromatic, along_y_[0]);
    filter(opponent_[1], filters_.red_green, along_y_[1]);
    filter(opponent_[2], filters_.blue_yellow[0], along_y_[2]);
    filter(opponent_[2], filters_.blue_yellow[1], along_y_[3]);
    for (int i = 0; i < kTilePixels; ++i) {
      const Vec3f opponent(along_y_[0][i], along_y_[1][i], along_y_[2][i] + along_y_[3][i]);
      const Vec3f rgb = rgb_from_xyz(xyz_from_opponent(opponent));
      look.lab[i] = hunt_lab_from_xyz(xyz_from_rgb(clamped(rgb)));
    }
  }

  // The constant part of the achromatic channel does not matter to derivatives.
  void find_features(TileLook& look) {
    filter_x(opponent_[0], filters_.across, along_x_[0]);
    filter_x(opponent_[0], filters_.edge, along_x_[1]);
    filter_x(opponent_[0], filters_.point, along_x_[2]);
    filter_y(along_x_[1], filters_.across, along_y_[0]);
    filter_y(along_x_[0], filters_.edge, along_y_[1]);
    filter_y(along_x_[2], filters_.across, along_y_[2]);
    filter_y(along_x_[0], filters_.point, along_y_[3]);
    const auto size = [](float x, float y) { return std::sqrt(x * x + y * y); };
    for (int i = 0; i < kTilePixels; ++i) {
      look.edge[i] = size(along_y_[0][i], along_y_[1][i]);
      look.point[i] = size(along_y_[2][i], along_y_[3][i]);
    }
  }

  // Section 4.3: the difference of features amplifies that of colours.
  float error_at(const TileLook& reference, int i) const {
    const float distance = color_distance(look_.lab[i], reference.lab[i]);
    const float knee = kColorKnee * largest_distance_;
    const float color_error =
        distance < knee ? distance * (kErrorAtKnee / knee)
                        : kErrorAtKnee + (1 - kErrorAtKnee) * (distance - knee) / (largest_distance_ - knee);
    const float feature =
        std::max(std::abs(look_.edge[i] - reference.edge[i]), std::abs(look_.point[i] - reference.point[i]));
    const float feature_error = std::sqrt(feature / (116 * std::numbers::sqrt2_v<float>));
    return std::min(std::pow(color_error, 1 - feature_error), 1.0f);
  }

  const FlipFilters& filters_;
  float largest_distance_;
  int stride_;                      // width and height of a tile and its margin
  std::vector<float> opponent_[3];  // stride_ x stride_
  std::vector<float> along_x_[3];   // kFlipTile x stride_
  std::vector<float> along_y_[4];
  TileLook look_, reference_look_;
};

void check_scale(double pixels_per_degree) {
  if (!(pixels_per_degree >= 1 && pixels_per_degree <= 1000)) {
    throw Error(ErrorCode::kBadParameter, "",
                "found " + std::to_string(pixels_per_degree) + " pixels per degree, expected 1 to 1000");
  }
}

int tiles_along(int pixels) { return (pixels + kFlipTile - 1) / kFlipTile; }

// Calls visit(comparison, number, x, y) for the tile at every (x, y), on all threads.
template <class Visit>
void for_each_tile(const Image& image, const FlipFilters& filters, Visit visit) {
  const float largest_distance = largest_color_distance();
  const int columns = tiles_along(image.width), rows = tiles_along(image.height);
  parallel_for(static_cast<std::int64_t>(columns) * rows, 1, [&](std::int64_t tile) {
    TileComparison comparison(filters, largest_distance);
    visit(comparison, static_cast<std::size_t>(tile), static_cast<int>(tile % columns) * kFlipTile,
          static_cast<int>(tile / columns) * kFlipTile);
  });
}

FlipError no_error(const Image& image) {
  return {image.width, image.height, std::vector<float>(image.pixel_count()), 0};
}

void find_mean(FlipError& error) {
  for (const float value : error.map) error.mean += value;
  error.mean /= static_cast<double>(error.map.size());
}

// The largest error over the exposures [EV], or that of the values as they are when there is none.
FlipError compare_tiles(const Image& image, const Image& reference, std::span<const double> exposures,
                        double pixels_per_degree) {
  check_pair(image, reference);
  check_scale(pixels_per_degree);
  FlipError error = no_error(image);
  for_each_tile(image, make_flip_filters(pixels_per_degree),
                [&](TileComparison& comparison, std::size_t, int x, int y) {
                  if (exposures.empty()) comparison.compare(image, reference, x, y, shown, error.map.data());
                  for (const double ev : exposures) {
                    const auto develop = [scale = static_cast<float>(std::exp2(ev))](const float* rgb) {
                      return shown_exposed(rgb, scale);
                    };
                    comparison.compare(image, reference, x, y, develop, error.map.data());
                  }
                });
  find_mean(error);
  return error;
}

// Andersson et al. 2021, section 3; the lower one where the number is even.
float median(std::vector<float>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

FlipError flip(const Image& image, const Image& reference, double pixels_per_degree) {
  return compare_tiles(image, reference, {}, pixels_per_degree);
}

struct FlipReference::Looks {
  int width, height;
  FlipFilters filters;
  std::vector<TileLook> tiles;
};

FlipReference::FlipReference(const Image& reference, double pixels_per_degree) {
  check_picture(reference, "the reference");
  check_scale(pixels_per_degree);
  looks_ = std::make_unique<Looks>();
  *looks_ = {reference.width, reference.height, make_flip_filters(pixels_per_degree), {}};
  looks_->tiles.resize(static_cast<std::size_t>(tiles_along(reference.width)) *
                       static_cast<std::size_t>(tiles_along(reference.height)));
  for_each_tile(reference, looks_->filters, [&](TileComparison& comparison, std::size_t tile, int x, int y) {
    comparison.look_at(reference, x, y, shown, looks_->tiles[tile]);
  });
}

FlipReference::~FlipReference() = default;
FlipReference::FlipReference(FlipReference&&) noexcept = default;
FlipReference& FlipReference::operator=(FlipReference&&) noexcept = default;

FlipError FlipReference::compare(const Image& image) const {
  check_size(image, looks_->width, looks_->height);
  check_picture(image, "the picture");
  FlipError error = no_error(image);
  for_each_tile(image, looks_->filters, [&](TileComparison& comparison, std::size_t tile, int x, int y) {
    comparison.compare(image, looks_->tiles[tile], x, y, shown, error.map.data());
  });
  find_mean(error);
  return error;
}

std::optional<FlipExposures> flip_exposures(const Image& reference) {
  check_picture(reference, "the reference");
  std::vector<float> luminances;
  luminances.reserve(reference.pixel_count());
  for (std::size_t i = 0; i < reference.pixel_count(); ++i) {
    const float* rgb = &reference.rgba[4 * i];
    luminances.push_back(
        xyz_from_rgb({std::max(rgb[0], 0.0f), std::max(rgb[1], 0.0f), std::max(rgb[2], 0.0f)}).y);
  }
  const float largest = *std::max_element(luminances.begin(), luminances.end());
  if (!(largest > 0)) return std::nullopt;
  float middle = median(luminances);
  if (!(middle > 0)) {
    std::erase_if(luminances, [](float luminance) { return !(luminance > 0); });
    middle = median(luminances);
  }
  const double brightest = inverse_flip_tone_curve(kBrightestShown);
  FlipExposures exposures{std::log2(brightest / largest), std::log2(brightest / middle), 2};
  exposures.count = std::max(2, static_cast<int>(std::ceil(exposures.stop_ev - exposures.start_ev)));
  return exposures;
}

FlipError flip_hdr(const Image& image, const Image& reference, const FlipExposures& exposures,
                   double pixels_per_degree) {
  const auto& [start_ev, stop_ev, count] = exposures;
  if (!(count >= 1 && std::isfinite(start_ev) && std::isfinite(stop_ev) && start_ev <= stop_ev)) {
    throw Error(ErrorCode::kBadParameter, "",
                "found " + std::to_string(count) + " exposures from " + std::to_string(start_ev) + " to " +
                    std::to_string(stop_ev) + " EV, expected at least one, in rising order");
  }
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    values.push_back(start_ev + (stop_ev - start_ev) * i / std::max(count - 1, 1));
  }
  return compare_tiles(image, reference, values, pixels_per_degree);
}

std::optional<FlipError> flip_hdr(const Image& image, const Image& reference, double pixels_per_degree) {
  check_pair(image, reference);
  const std::optional<FlipExposures> exposures = flip_exposures(reference);
  if (!exposures) return std::nullopt;
  return flip_hdr(image, reference, *exposures, pixels_per_degree);
}

}  // namespace voxlume
