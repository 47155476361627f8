#include "grid/derive.h"

#include <fmt/format.h>
#include <itkGaussianOperator.h>
#include <itkImage.h>
#include <itkNeighborhoodOperatorImageFilter.h>
#include <itkRecursiveGaussianImageFilter.h>
#include <itkSignedMaurerDistanceMapImageFilter.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <vector>

#include "base/fail.h"
#include "base/parallel.h"
#include "base/progress_parts.h"
#include "grid/grid_view.h"
#include "volume_io/memory_limit.h"

namespace voxlume {
namespace {

using FloatImage = itk::Image<float, 3>;
using MaskImage = itk::Image<std::uint8_t, 3>;

/// An image with the volume's size and spacing along its own axes, which is all that the filters look at.
template <class Image>
typename Image::Pointer make_image(const Volume& volume) {
  typename Image::SizeType size;
  typename Image::SpacingType spacing;
  for (unsigned a = 0; a < 3; ++a) {
    size[a] = static_cast<itk::SizeValueType>(volume.size[a]);
    spacing[a] = volume.spacing_mm[a];
  }
  auto image = Image::New();
  image->SetRegions(size);
  image->SetSpacing(spacing);
  image->Allocate();
  return image;
}

/// `voxels` where `volume` lies.
Volume placed_as(const Volume& volume, std::shared_ptr<const void> voxels) {
  Volume out;
  out.size = volume.size;
  out.type = VoxelType::kF32;
  out.spacing_mm = volume.spacing_mm;
  out.origin_mm = volume.origin_mm;
  out.direction = volume.direction;
  out.voxels = std::move(voxels);
  out.format = "derived";
  return out;
}

Volume placed_as(const Volume& volume, const FloatImage::Pointer& image) {
  return placed_as(volume, {image->GetBufferPointer(), [image](const void*) {}});
}

void check_working_memory(const Volume& volume, std::uint64_t bytes_a_voxel, const char* what) {
  check_memory(what, volume, volume.voxel_count() * bytes_a_voxel, 0);
}

/// Calls visit(first, count) for the slices of a volume, in parallel.
template <class Visit>
void each_slice(const Volume& volume, Visit&& visit) {
  const std::int64_t count = volume.size[0] * volume.size[1];
  parallel_for(volume.size[2], 1, [&](std::int64_t k) { visit(k * count, count); });
}

/// Tells of a filter's own progress, which goes back at times where a filter is made of others. What telling
/// throws does not pass through the library, but ends the work after it.
template <class Filter>
typename Filter::OutputImageType::Pointer run(Filter& filter, const Progress& progress) {
  std::exception_ptr thrown;
  float told = 0;
  if (progress)
    filter.AddObserver(itk::ProgressEvent(), [&](const itk::EventObject&) {
      if (thrown || filter.GetProgress() <= told) return;
      told = filter.GetProgress();
      try {
        progress(told);
      } catch (...) {
        thrown = std::current_exception();
      }
    });
  try {
    filter.SetNumberOfWorkUnits(static_cast<itk::ThreadIdType>(thread_count()));
    filter.Update();
  } catch (const itk::ExceptionObject& error) {
    fail(ErrorCode::kInternal, "", error.GetDescription());
  }
  filter.RemoveAllObservers();
  if (thrown) std::rethrow_exception(thrown);
  typename Filter::OutputImageType::Pointer image = filter.GetOutput();
  image->DisconnectPipeline();
  return image;
}

template <class T>
void gradient_row(const T* row, std::int64_t n, std::int64_t next_j, std::int64_t last_j, std::int64_t next_k,
                  std::int64_t last_k, Vec3f half_per_mm, float* out) {
  for (std::int64_t i = 0; i < n; ++i) {
    const auto across = [&](std::int64_t next, std::int64_t last) {
      return static_cast<float>(row[i + next]) - static_cast<float>(row[i - last]);
    };
    const Vec3f gradient =
        Vec3f(across(i + 1 < n, i > 0), across(next_j, last_j), across(next_k, last_k)) * half_per_mm;
    out[i] = length(gradient);
  }
}

/// The voxels as floats, those that are not finite as the smallest that is.
FloatImage::Pointer finite_image(const Volume& volume) {
  auto image = make_image<FloatImage>(volume);
  float* out = image->GetBufferPointer();
  float smallest = std::numeric_limits<float>::max();
  bool finite = true;
  std::mutex mutex;
  with_voxels(volume.type, volume.voxels.get(), [&](const auto* voxels) {
    each_slice(volume, [&](std::int64_t first, std::int64_t count) {
      float least = std::numeric_limits<float>::max();
      bool all_finite = true;
      for (std::int64_t at = first; at < first + count; ++at) {
        const float v = out[at] = static_cast<float>(voxels[at]);
        if (std::isfinite(v))
          least = std::min(least, v);
        else
          all_finite = false;
      }
      const std::lock_guard lock(mutex);
      smallest = std::min(smallest, least);
      finite = finite && all_finite;
    });
  });
  if (finite) return image;
  if (smallest == std::numeric_limits<float>::max()) smallest = 0;
  each_slice(volume, [&](std::int64_t first, std::int64_t count) {
    for (std::int64_t at = first; at < first + count; ++at)
      if (!std::isfinite(out[at])) out[at] = smallest;
  });
  return image;
}

/// Deriche's recursion, whose cost does not grow with sigma; its impulse response is off for narrow kernels,
/// and it needs four voxels.
FloatImage::Pointer smoothed_widely(FloatImage* image, unsigned axis, double sigma_mm,
                                    const Progress& progress) {
  auto filter = itk::RecursiveGaussianImageFilter<FloatImage, FloatImage>::New();
  filter->SetInput(image);
  filter->SetDirection(axis);
  filter->SetZeroOrder();
  filter->SetSigma(sigma_mm);
  filter->InPlaceOn();
  return run(*filter, progress);
}

/// Lindeberg's discrete Gaussian, whose variance is exact however narrow it is.
FloatImage::Pointer smoothed_narrowly(FloatImage* image, unsigned axis, double sigma_voxels,
                                      const Progress& progress) {
  itk::GaussianOperator<float, 3> kernel;
  kernel.SetDirection(axis);
  kernel.SetVariance(sigma_voxels * sigma_voxels);
  kernel.SetMaximumError(1e-4);
  kernel.SetMaximumKernelWidth(static_cast<unsigned>(16 * sigma_voxels) + 32);
  kernel.CreateDirectional();
  auto filter = itk::NeighborhoodOperatorImageFilter<FloatImage, FloatImage, float>::New();
  filter->SetInput(image);
  filter->SetOperator(kernel);
  return run(*filter, progress);
}

/// 1 for voxels of the labels `inside`, else 0; and how many there are.
MaskImage::Pointer find_mask(const Volume& labels, std::span<const float> inside,
                             std::int64_t& inside_count) {
  std::vector<float> sorted(inside.begin(), inside.end());
  std::erase_if(sorted, [](float label) { return std::isnan(label); });
  std::sort(sorted.begin(), sorted.end());
  auto mask = make_image<MaskImage>(labels);
  std::uint8_t* out = mask->GetBufferPointer();
  std::atomic<std::int64_t> total{0};
  with_voxels(labels.type, labels.voxels.get(), [&]<class T>(const T* voxels) {
    const auto is_inside = [&](T v) {
      const auto label = static_cast<float>(v);
      return label == label && std::binary_search(sorted.begin(), sorted.end(), label);
    };
    each_slice(labels, [&](std::int64_t first, std::int64_t count) {
      T last = voxels[first];
      bool last_inside = is_inside(last);
      std::int64_t found = 0;
      for (std::int64_t at = first; at < first + count; ++at) {
        if (!(voxels[at] == last)) last_inside = is_inside(last = voxels[at]);
        out[at] = last_inside;
        found += last_inside;
      }
      total += found;
    });
  });
  inside_count = total;
  return mask;
}

/// Distance of voxels whose mask is `side` from the nearest voxel centre whose mask is not [mm].
FloatImage::Pointer distance_image(MaskImage* mask, std::uint8_t side, const Progress& progress) {
  auto filter = itk::SignedMaurerDistanceMapImageFilter<MaskImage, FloatImage>::New();
  filter->SetInput(mask);
  filter->SetBackgroundValue(side);
  filter->SetInsideIsPositive(false);
  filter->SetSquaredDistance(false);
  filter->SetUseImageSpacing(true);
  return run(*filter, progress);
}

/// Moves the boundary from the nearest voxel centre of the other side to where that voxel begins: half a
/// voxel's width along the direction to it, which the slope of `distance` tells.
void place_boundary(const Volume& volume, const float* distance, float* out) {
  const std::int64_t stride[3] = {1, volume.size[0], volume.size[0] * volume.size[1]};
  parallel_for(volume.size[1] * volume.size[2], 16, [&](std::int64_t row) {
    std::int64_t at[3] = {0, row % volume.size[1], row / volume.size[1]};
    const float* d = distance + row * volume.size[0];
    for (; at[0] < volume.size[0]; ++at[0]) {
      const float* here = d + at[0];
      double square = 0, width_square = 0;
      for (int a = 0; a < 3; ++a) {
        const double change = double{here[at[a] + 1 < volume.size[a] ? stride[a] : 0]} -
                              double{here[at[a] > 0 ? -stride[a] : 0]};
        square += change * change / (volume.spacing_mm[a] * volume.spacing_mm[a]);
        width_square += change * change;
      }
      const double half_width = square > 0 ? 0.5 * std::sqrt(width_square / square) : 0;
      const double from_centre = std::abs(*here);
      out[row * volume.size[0] + at[0]] =
          static_cast<float>(std::copysign(from_centre - std::min(half_width, 0.5 * from_centre), *here));
    }
  });
}

}  // namespace

Volume gradient_magnitude(const Volume& volume, const Progress& progress) {
  check_working_memory(volume, sizeof(float), "gradient magnitude");
  const GridView grid = make_grid_view(volume);
  auto magnitude = std::make_shared<std::vector<float>>(volume.voxel_count());
  Vec3f half_per_mm;
  for (int a = 0; a < 3; ++a) half_per_mm[a] = static_cast<float>(0.5 / volume.spacing_mm[a]);
  const std::int64_t rows = std::int64_t{grid.size[1]} * grid.size[2];
  ProgressCounter rows_done(rows, progress);
  with_voxels(grid.type, grid.voxels, [&](const auto* voxels) {
    parallel_for(rows, 16, [&](std::int64_t row) {
      const std::int64_t j = row % grid.size[1], k = row / grid.size[1], first = row * grid.size[0];
      gradient_row(voxels + first, grid.size[0], j + 1 < grid.size[1] ? grid.stride_j : 0,
                   j > 0 ? grid.stride_j : 0, k + 1 < grid.size[2] ? grid.stride_k : 0,
                   k > 0 ? grid.stride_k : 0, half_per_mm, magnitude->data() + first);
      rows_done.add();
    });
  });
  return placed_as(volume, {magnitude, magnitude->data()});
}

Volume smoothed(const Volume& volume, double sigma_mm, const Progress& progress) {
  constexpr double kWide_voxels = 3;
  if (!(sigma_mm >= 0 && std::isfinite(sigma_mm)))
    fail(ErrorCode::kBadParameter, "smoothed volume",
         fmt::format("sigma is {} mm, expected 0 or more", sigma_mm));
  check_working_memory(volume, 2 * sizeof(float), "smoothed volume");
  FloatImage::Pointer image = finite_image(volume);
  for (unsigned a = 0; a < 3; ++a) {
    const double sigma_voxels = sigma_mm / volume.spacing_mm[a];
    if (volume.size[a] == 1 || sigma_voxels == 0) continue;
    const Progress of_axis = part_of(progress, static_cast<int>(a), 3);
    if (sigma_voxels >= kWide_voxels && volume.size[a] >= 4)
      image = smoothed_widely(image, a, sigma_mm, of_axis);
    else
      image = smoothed_narrowly(image, a, std::min(sigma_voxels, kWide_voxels), of_axis);
  }
  return placed_as(volume, image);
}

Volume signed_distance(const Volume& labels, std::span<const float> inside, const Progress& progress) {
  // The mask; two distances, one of them being computed from an image of as much again with lists of its
  // runs.
  check_working_memory(labels, 20, "signed distance");
  std::int64_t inside_count = 0;
  const MaskImage::Pointer mask = find_mask(labels, inside, inside_count);
  const bool none = inside_count == 0;
  if (none || inside_count == static_cast<std::int64_t>(labels.voxel_count())) {
    const auto image = make_image<FloatImage>(labels);
    image->FillBuffer(none ? -kNoBoundary_mm : kNoBoundary_mm);
    return placed_as(labels, image);
  }
  const FloatImage::Pointer to_outside = distance_image(mask, 1, part_of(progress, 0, 2)),
                            to_inside = distance_image(mask, 0, part_of(progress, 1, 2));
  float* distance = to_outside->GetBufferPointer();
  const float* negative = to_inside->GetBufferPointer();
  const std::uint8_t* is_inside = mask->GetBufferPointer();
  each_slice(labels, [&](std::int64_t first, std::int64_t count) {
    for (std::int64_t at = first; at < first + count; ++at)
      if (!is_inside[at]) distance[at] = -negative[at];
  });
  place_boundary(labels, distance, to_inside->GetBufferPointer());
  return placed_as(labels, to_inside);
}

}  // namespace voxlume
