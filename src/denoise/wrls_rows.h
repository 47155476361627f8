#pragma once
#include <vector>

#include "denoise/frame.h"
#include "denoise/reprojection.h"

namespace voxlume {

/// lambda of iglesias2020 eqs. 10 and 11.
constexpr float kWrlsForgetting = 0.998f;
/// alpha of eq. 12, the share of the history in the feature.
constexpr float kWrlsHistory = 0.75f;
/// h of eq. 13.
constexpr float kWrlsBandwidth = 0.75f;
/// epsilon of eq. 13, in units of the frame's brightness.
constexpr float kWrlsEpsilon = 1e-3f;
/// The diagonal of the first P: of the model with the feature, which starts with what the feature says and
/// is to leave it slowly (in units of the frame's brightness^-2 but for the intercept), and of that without.
constexpr float kWrlsFirstP = 0.05f, kWrlsFirstPWithoutFeature = 1;
/// An element of the diagonal of P may grow to so many times its first value.
constexpr float kWrlsLargestGrowth = 2;
/// A sample may shrink P by so much: more would cancel all digits of a float.
constexpr float kWrlsLargestGain = 1000;
/// Radiance above so many times the frame's brightness is cut.
constexpr float kWrlsBrightest = 1 << 20;
/// Matter that was further from where it is expected than so many times the frame's size is other matter.
constexpr float kWrlsDepthTolerance = 0.05f;
/// The spatial filter reaches so many pixels to each side.
constexpr int kWrlsReach = 2;

/// What the pixels' models know after a frame.
struct WrlsModels {
  /// P of eq. 11, inverse covariance of the predictors: its upper triangle, row by row. 10 planes, or 1
  /// without the feature.
  std::vector<Plane> p;
  /// beta of eq. 9: the coefficient of predictor a for channel c is in plane 3 a + c. 12 planes, or 3.
  std::vector<Plane> beta;
  Planes3 z;       ///< the feature of eq. 12 [radiance]
  Plane z_alpha;   ///< alpha, smoothed like z
  Plane spread;    ///< smoothed squared distance d of eq. 13: the noise of a pixel relative to its brightness
  Plane depth_mm;  ///< of the matter that the model belongs to; 0: the model knows nothing
};

/// By what the spatial filter tells pixels apart.
struct WrlsGuide {
  Planes3 colour;   ///< logarithm of z's brightness, and its two chromas over its brightness
  Plane sharpness;  ///< -1 / (2 sigma^2), where sigma is the distance at which pixels begin to differ
  Plane inside;     ///< 1 in the picture, 0 in the border
};

/// Sum over the matter of a row.
struct WrlsBrightness {
  double log2_sum = 0;  ///< of luminance / alpha
  double count = 0;
};

/// Of the pixels that have light and matter.
void measure_brightness_row(const DenoiseFrame& frame, int y, WrlsBrightness& row);

struct WrlsUpdate {
  const DenoiseFrame& frame;
  const Reprojection& moved;
  float scale;  ///< the frame's brightness [radiance], > 0
  bool weighted;
  int frame_number;
  const WrlsModels& before;
  WrlsModels& after;
  WrlsGuide& guide;
};

/// The temporal stage: models and guide of a row of pixels.
void update_models_row(const WrlsUpdate& update, int y);

/// The spatial stage: a row of the picture.
void predict_row(const WrlsModels& models, const WrlsGuide& guide, int y, DenoisedFrame& out);

}  // namespace voxlume
