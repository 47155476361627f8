#include "denoise/frame.h"

namespace voxlume {

DenoiseFrame make_denoise_frame(int width, int height) {
  const Plane plane(width, height);
  const Planes3 planes{plane, plane, plane};
  DenoiseFrame frame;
  frame.width = width;
  frame.height = height;
  frame.radiance = frame.background = frame.normal = frame.albedo = planes;
  frame.alpha = frame.depth_mm = frame.variance = frame.samples = plane;
  return frame;
}

void add_classes(DenoiseFrame& frame) {
  const Plane plane(frame.width, frame.height);
  const Planes3 planes{plane, plane, plane};
  const SampleClass empty{plane, planes, planes, planes, planes, planes};
  frame.classes = {empty, empty};
}

void DenoisedFrame::resize(int width, int height) {
  if (alpha.width() == width && alpha.height() == height) return;
  radiance = make_planes3(width, height);
  alpha = Plane(width, height);
}

}  // namespace voxlume
