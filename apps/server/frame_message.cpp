#include "server/frame_message.h"

#include <nlohmann/json.hpp>

#include "server/picture_bytes.h"

namespace voxlume::server {
namespace {

using nlohmann::json;

const char* limit_name(LiveLimit limit) {
  switch (limit) {
    case LiveLimit::kTracing:
      return "tracing";
    case LiveLimit::kDenoising:
      return "denoising";
    case LiveLimit::kCompiling:
      return "compiling";
    case LiveLimit::kDeveloping:
      return "developing";
    case LiveLimit::kNothing:
      break;
  }
  return "nothing";
}

json triple(Vec3f v) { return {v.x, v.y, v.z}; }

json camera_json(const CameraView& camera) {
  return {{"eye_mm", triple(camera.eye_mm)},
          {"right", triple(camera.right)},
          {"up", triple(camera.up)},
          {"forward", triple(camera.forward)},
          {"half_width", camera.half_width},
          {"half_height", camera.half_height},
          {"orthographic", camera.orthographic}};
}

json header(const LiveFrame& frame, const FrameNumbering& numbering, bool jpeg, double fps) {
  json out{{"frame", frame.number + numbering.frames_before},
           {"revision", frame.revision + numbering.revisions_before},
           {"moving", frame.moving},
           {"format", jpeg ? "jpeg" : "png"},
           {"width", frame.picture.width},
           {"height", frame.picture.height},
           {"full", {frame.width, frame.height}},
           {"spp", frame.spp},
           {"done", frame.done},
           {"frame_s", frame.frame_s},
           {"compile_s", frame.compile_s},
           {"trace_s", frame.trace_s},
           {"denoise_s", frame.denoise_s},
           {"develop_s", frame.develop_s},
           {"fps", fps},
           {"limit", limit_name(frame.limit)},
           {"camera", camera_json(frame.camera)}};
  out["noise"] = frame.noise ? json(*frame.noise) : json(nullptr);
  return out;
}

}  // namespace

FrameMessage FrameCoder::code(std::shared_ptr<const LiveFrame> frame, const FrameNumbering& numbering) {
  constexpr double kWeight = 0.2;
  if (frame->moving && frame->frame_s > 0)
    mean_frame_s_ =
        mean_frame_s_ > 0 ? mean_frame_s_ + kWeight * (frame->frame_s - mean_frame_s_) : frame->frame_s;
  const bool jpeg =
      (frame->moving || frame->hurried) && frame->picture.channels == 3;  // JPEG has no transparency
  const std::string picture = jpeg ? jpeg_bytes(frame->picture) : png_bytes(frame->picture);
  const std::string text = header(*frame, numbering, jpeg, mean_frame_s_ > 0 ? 1 / mean_frame_s_ : 0).dump();
  std::string bytes;
  bytes.reserve(4 + text.size() + picture.size());
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(text.size() >> shift & 255);
  bytes += text;
  bytes += picture;
  FrameMessage out;
  out.number = frame->number + numbering.frames_before;
  out.frame = std::move(frame);
  out.bytes = std::make_shared<const std::string>(std::move(bytes));
  return out;
}

}  // namespace voxlume::server
