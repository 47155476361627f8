// Times the denoisers over a synthetic sequence: a textured ball before a wall, part of it translucent, the
// camera turning around it. JSON to standard output. Usage: voxlume_denoise_speed [ROUNDS [WIDTH HEIGHT]]
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>

#include "base/parallel.h"
#include "denoise/denoiser.h"
#include "measure.h"
#include "voxlume/error.h"

namespace {

using namespace voxlume;
using Json = nlohmann::ordered_json;

constexpr float kRadius_mm = 150;
constexpr int kSamples = 4;

/// What a ray meets: the ball about the origin, or the wall behind it that does not reach all sides.
struct Meeting {
  float depth_mm = 0, alpha = 0;
  Vec3f normal, albedo;
  float light = 0;
};

Meeting meet(const CameraRay& ray) {
  constexpr float kBall_mm = 90;
  const float b = dot(ray.origin, ray.direction);
  const float c = dot(ray.origin, ray.origin) - kBall_mm * kBall_mm;
  const float discriminant = b * b - c;
  const Vec3f light_direction = normalize(Vec3f(0.4f, -0.7f, 0.6f));
  Meeting m;
  Vec3f p;
  if (discriminant > 0) {
    m.depth_mm = -b - std::sqrt(discriminant);
    p = ray.origin + ray.direction * m.depth_mm;
    m.normal = normalize(p);
    m.alpha = p.z > 0 ? 1.0f : 0.4f;
  } else {
    m.depth_mm = (100 - ray.origin.y) / ray.direction.y;
    p = ray.origin + ray.direction * m.depth_mm;
    if (!(m.depth_mm > 0) || std::abs(p.x) > 220 || std::abs(p.z) > 110) return {};
    m.normal = Vec3f(0, -1, 0);
    m.alpha = 1;
  }
  const bool checker =
      ((static_cast<int>(std::floor(p.x / 15)) + static_cast<int>(std::floor(p.z / 15))) & 1) != 0;
  m.albedo = checker ? Vec3f(0.8f, 0.5f, 0.4f) : Vec3f(0.4f, 0.5f, 0.7f);
  m.light = 0.2f + 0.8f * std::max(0.0f, dot(m.normal, light_direction));
  return m;
}

void render_pixel(DenoiseFrame& frame, int x, int y, std::mt19937& random) {
  const Meeting m =
      meet(camera_ray(frame.camera, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0, 0));
  std::uniform_real_distribution<float> uniform;
  std::exponential_distribution<float> noise;
  frame.samples.at(x, y) = kSamples;
  int count = 0;
  float sum = 0, squares = 0;
  for (int i = 0; i < kSamples; ++i) {
    if (uniform(random) >= m.alpha) continue;
    const float f = noise(random);
    ++count;
    sum += f;
    squares += f * f;
  }
  if (count == 0) return;
  const float mean = sum / kSamples, scattered = static_cast<float>(count);
  const float y_light = luminance(m.albedo) * m.light;
  frame.alpha.at(x, y) = scattered / kSamples;
  frame.depth_mm.at(x, y) = m.depth_mm;
  frame.variance.at(x, y) = (squares / kSamples - mean * mean) / (kSamples - 1) * y_light * y_light;
  // Every other sample has met something of half the albedo: both classes are there nearly everywhere.
  const int second = count / 2;
  const float fx[2] = {1, 0.5f}, counts[2] = {static_cast<float>(count - second), static_cast<float>(second)};
  for (int k = 0; k < 2; ++k) (*frame.classes)[k].count.at(x, y) = counts[k];
  for (int c = 0; c < 3; ++c) {
    frame.radiance[c].at(x, y) = m.albedo[c] * m.light * mean;
    frame.normal[c].at(x, y) = m.normal[c];
    frame.albedo[c].at(x, y) = m.albedo[c];
    for (int k = 0; k < 2; ++k) {
      if (counts[k] == 0) continue;
      (*frame.classes)[k].fx_diffuse[c].at(x, y) = m.albedo[c] * fx[k];
      (*frame.classes)[k].fl_diffuse[c].at(x, y) = m.light * sum / scattered / fx[k];
    }
  }
}

DenoiseFrame make_frame(int width, int height, int index) {
  DenoiseFrame frame = make_denoise_frame(width, height);
  add_classes(frame);
  CameraDescription camera;
  camera.azimuth_deg = 1.0 * index;
  camera.elevation_deg = 10;
  frame.camera = compile_camera(camera, Vec3f(0), kRadius_mm, width, height);
  frame.size_mm = kRadius_mm;
  std::mt19937 random(static_cast<unsigned>(index) + 1);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) render_pixel(frame, x, y, random);
  }
  const Plane strata((width + 2) / 3, (height + 2) / 3);
  frame.gradients = {strata, strata, strata};
  for (int y = 0; y < strata.height(); ++y) {
    for (int x = 0; x < strata.width(); ++x) {
      const int px = std::min(3 * x + 1, width - 1), py = std::min(3 * y + 1, height - 1);
      frame.gradients->now.at(x, y) = frame.gradients->before.at(x, y) = frame.radiance[1].at(px, py);
      frame.gradients->valid.at(x, y) = frame.alpha.at(px, py) > 0 ? 1.0f : 0.0f;
    }
  }
  return frame;
}

struct Timed {
  const DenoiserKind* kind = nullptr;
  std::unique_ptr<Denoiser> denoiser{};
  DenoisedFrame out{};
  std::string missing{};  ///< why it does not run here
  std::vector<double> one_thread_ms{}, all_threads_ms{};
  double spent_ms = 0;
};

/// A method that has taken as long as this is not measured again.
constexpr double kEnough_ms = 20e3;

/// On one thread it is processor time, which leaves out what other programs take; wall time on all.
double time_ms(Timed& timed, const DenoiseFrame& frame, int threads) {
  const ThreadLimit limit(threads);
  const auto clock = threads == 1 ? processor_ms : now_ms;
  const double start = clock(), start_wall = now_ms();
  timed.denoiser->denoise(frame, timed.out);
  timed.spent_ms += now_ms() - start_wall;
  return clock() - start;
}

std::vector<Timed> make_all(const DenoiseFrame& frame) {
  std::vector<Timed> all;
  for (const DenoiserKind& kind : denoiser_kinds()) {
    Timed& timed = all.emplace_back(Timed{.kind = &kind});
    try {
      timed.denoiser = kind.make();
      timed.denoiser->denoise(frame, timed.out);
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kUnsupported) throw;
      timed.missing = error.what();
    }
  }
  return all;
}

Json measure(int rounds, int width, int height) {
  std::vector<DenoiseFrame> frames;
  for (int i = 0; i < 4; ++i) frames.push_back(make_frame(width, height, i));
  std::vector<Timed> all = make_all(frames[0]);
  for (int round = 0; round < rounds; ++round) {
    for (Timed& timed : all) {
      if (!timed.missing.empty() || timed.spent_ms > kEnough_ms) continue;
      // There and back again: each frame is next to the one before.
      timed.all_threads_ms.push_back(time_ms(timed, frames[round % 2 == 0 ? 1 : 3], 0));
      timed.one_thread_ms.push_back(time_ms(timed, frames[round % 2 == 0 ? 2 : 0], 1));
    }
  }
  const double megapixels = 1e-6 * width * height;
  Json methods = Json::array();
  for (const Timed& timed : all) {
    Json method{{"name", timed.kind->name}};
    if (!timed.missing.empty()) {
      method["missing"] = timed.missing;
    } else {
      const double one = median(timed.one_thread_ms), threads = median(timed.all_threads_ms);
      method["frame_ms"] = {{"one_thread", one}, {"all_threads", threads}};
      method["megapixel_ms"] = {{"one_thread", one / megapixels}, {"all_threads", threads / megapixels}};
    }
    methods.push_back(method);
  }
  return {{"width", width},
          {"height", height},
          {"rounds", rounds},
          {"threads", thread_count()},
          {"methods", methods}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 1 && argc != 2 && argc != 4) {
    std::fprintf(stderr, "usage: voxlume_denoise_speed [ROUNDS [WIDTH HEIGHT]]\n");
    return 2;
  }
  const auto argument = [&](int i, int otherwise) {
    return argc > i ? std::max(1, std::atoi(argv[i])) : otherwise;
  };
  try {
    std::cout << measure(argument(1, 7), argument(2, 1280), argument(3, 720)).dump(2) << "\n";
  } catch (const Error& error) {
    std::fprintf(stderr, "voxlume_denoise_speed: %s\n", error.what());
    return 1;
  }
  return 0;
}
