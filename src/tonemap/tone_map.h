#pragma once
#include "voxlume/image.h"
#include "voxlume/scene.h"

namespace voxlume {

/// How a linear picture is developed for display.
struct ToneMap {
  double exposure_ev = 0;                ///< radiance is multiplied by 2^EV first
  ToneCurve curve = ToneCurve::kFilmic;  ///< kSrgb: clamp to [0,1] only
  bool transparent = false;              ///< keep alpha (four channels); else it is dropped
  bool dither = false;                   ///< ordered dithering, 8 x 8, against bands in smooth gradients
};

/// The filmic curve, linear [0, inf) to linear [0, 1], increasing until it reaches 1 at about 10: Narkowicz
/// 2016, "ACES Filmic Tone Mapping Curve", f(y) = y (2.51 y + 0.03) / (y (2.43 y + 0.59) + 0.14), at y = s x,
/// where s is such that mid-grey stays what it is: f(0.18 s) = 0.18. Radiance 1 maps to 0.73, 4 to 0.95.
float filmic(float linear);

/// Develops a picture: exposure, curve and sRGB encoding of each channel, rounded to 8 bits. With
/// `transparent` the colour is divided by alpha before the curve, since the curve belongs to what the pixel
/// shows and not to how much of the pixel it covers; where alpha is zero the colour is black. Values that are
/// not finite become zero. The metadata is kept, the layers are not.
Image8 tone_map(const Image& image, const ToneMap& settings = {});

}  // namespace voxlume
