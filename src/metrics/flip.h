#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "voxlume/image.h"

namespace voxlume {

// FLIP: how large the difference seems to somebody who looks at the picture and the reference in turn, in the
// same place. LDR-FLIP: Andersson et al. 2020, "FLIP: A Difference Evaluator for Alternating Images";
// HDR-FLIP: Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images". Both compare
// R, G and B (premultiplied, as they are) and leave alpha and layers alone. The results do not depend on the
// number of threads. Each throws Error kBadParameter when the sizes differ, a picture is empty, a value is
// not finite, or `pixels_per_degree` is not in [1, 1000].

/// Pixels in a degree of visual angle, seen from 0.7 m on a display 0.7 m wide with 3840 pixels: 67.02.
inline constexpr double kFlipPixelsPerDegree = 67.02064327658225;

/// 0 is no visible difference, 1 the largest there is (as between the display's green and blue).
struct FlipError {
  int width = 0, height = 0;
  std::vector<float> map;  ///< of every pixel, row by row from the top; in [0,1]
  double mean = 0;         ///< of the map
};

/// LDR-FLIP of what a display shows at EV 0: of the linear values clamped to [0,1]. Symmetric.
FlipError flip(const Image& image, const Image& reference, double pixels_per_degree = kFlipPixelsPerDegree);

/// The same for many pictures and one reference, whose look is found once.
class FlipReference {
 public:
  explicit FlipReference(const Image& reference, double pixels_per_degree = kFlipPixelsPerDegree);
  ~FlipReference();
  FlipReference(FlipReference&&) noexcept;
  FlipReference& operator=(FlipReference&&) noexcept;

  /// flip(image, reference, pixels_per_degree), bit for bit; from any thread.
  FlipError compare(const Image& image) const;

 private:
  struct Looks;
  std::unique_ptr<Looks> looks_;
};

/// The exposures that HDR-FLIP looks at: `count` >= 1 of them, evenly spaced from start_ev to stop_ev
/// [stops], both finite and start_ev <= stop_ev. One exposure is start_ev.
struct FlipExposures {
  double start_ev = 0, stop_ev = 0;
  int count = 1;
};

/// The exposures at which the brightest and the median luminance of the reference reach 0.85 of the display's
/// range, and at least two, about a stop apart. Negative values count as 0. The median is of all pixels (the
/// lower one of an even number) or, where that is 0, as over a black background, of the pixels that are not
/// black. Absent when all pixels are black. Throws Error kBadParameter when the picture is empty or a value
/// is not finite.
std::optional<FlipExposures> flip_exposures(const Image& reference);

/// HDR-FLIP of linear values: of every pixel the largest LDR-FLIP over the exposures. Not symmetric where the
/// exposures are the reference's own. Throws Error kBadParameter as well when the exposures are not as
/// FlipExposures says.
FlipError flip_hdr(const Image& image, const Image& reference, const FlipExposures& exposures,
                   double pixels_per_degree = kFlipPixelsPerDegree);

/// The same with flip_exposures(reference); absent where they are.
std::optional<FlipError> flip_hdr(const Image& image, const Image& reference,
                                  double pixels_per_degree = kFlipPixelsPerDegree);

}  // namespace voxlume
