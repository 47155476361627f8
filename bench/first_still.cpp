// How good moving pictures are, and from how many samples on a still one is better: errors against a
// converged picture, as the page shows both. A moving picture is traced small, one sample a pixel, denoised
// with the frames before it, and drawn at full size; a still is denoised alone. `smooth` is the error where
// the converged picture is smooth (the half of all 8 x 8 pixels that vary least, background aside), which
// shows as mottles: a moving picture errs at edges above all. Prints JSON. Usage: voxlume_first_still VOLUME
// PRESET [DENOISER [WIDTHxHEIGHT [SPP]]]
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "measure.h"
#include "metrics/flip.h"
#include "render/picture.h"
#include "render/session.h"
#include "tonemap/srgb.h"
#include "tonemap/tone_map.h"
#include "voxlume/error.h"

namespace {

using namespace voxlume;
using Json = nlohmann::ordered_json;

/// A picture as the screen has it: sRGB values in R, G and B.
Image on_screen(const Image& linear, const SceneDescription& scene, int width, int height) {
  const Image8 shown = tone_map(linear, {scene.image.exposure_ev, scene.image.tone_curve, false, false});
  Image out(width, height);
  const auto at = [](int i, int count, int from) {
    return std::clamp((i + 0.5) * from / count - 0.5, 0.0, from - 1.0);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = at(x, width, shown.width), v = at(y, height, shown.height);
      const int i = std::min(static_cast<int>(u), std::max(0, shown.width - 2));
      const int j = std::min(static_cast<int>(v), std::max(0, shown.height - 2));
      for (int c = 0; c < 3; ++c) {
        const auto value = [&](int dx, int dy) {
          return static_cast<double>(
              shown.values[static_cast<std::size_t>(((j + dy) * shown.width + i + dx) * 3 + c)]);
        };
        const double top = value(0, 0) + (u - i) * (value(1, 0) - value(0, 0));
        const double bottom = value(0, 1) + (u - i) * (value(1, 1) - value(0, 1));
        out.pixel(x, y)[c] = static_cast<float>((top + (v - j) * (bottom - top)) / 255);
      }
    }
  return out;
}

Image decoded(Image screen) {
  for (float& value : screen.rgba) value = linear_from_srgb(value);
  return screen;
}

constexpr int kBlock = 8;

struct Block {
  int x = 0, y = 0;
};

/// Calls visit(value in levels of 8 bits) for the green of each pixel of a block.
template <class Visit>
void for_pixels(const Image& screen, Block block, Visit&& visit) {
  for (int y = block.y; y < block.y + kBlock; ++y)
    for (int x = block.x; x < block.x + kBlock; ++x) visit(255.0 * screen.pixel(x, y)[1], x, y);
}

double spread(const Image& screen, Block block) {
  double sum = 0, squares = 0;
  for_pixels(screen, block, [&](double value, int, int) {
    sum += value;
    squares += value * value;
  });
  const double mean = sum / (kBlock * kBlock);
  return std::sqrt(std::max(0.0, squares / (kBlock * kBlock) - mean * mean));
}

std::vector<Block> smooth_blocks(const Image& reference) {
  constexpr double kFlat = 0.2;  // no matter varies so little
  std::vector<std::pair<double, Block>> all;
  for (int y = 0; y + kBlock <= reference.height; y += kBlock)
    for (int x = 0; x + kBlock <= reference.width; x += kBlock)
      if (const double s = spread(reference, {x, y}); s > kFlat) all.push_back({s, {x, y}});
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Block> out;
  for (std::size_t i = 0; i < all.size() / 2; ++i) out.push_back(all[i].second);
  return out;
}

std::vector<Block> whole(const Image& picture) {
  std::vector<Block> out;
  for (int y = 0; y + kBlock <= picture.height; y += kBlock)
    for (int x = 0; x + kBlock <= picture.width; x += kBlock) out.push_back({x, y});
  return out;
}

/// Root mean square of the differences, in levels of 8 bits.
double rms(const Image& a, const Image& b, const std::vector<Block>& blocks) {
  double sum = 0;
  for (const Block& block : blocks)
    for_pixels(a, block, [&](double value, int x, int y) {
      const double off = value - 255.0 * b.pixel(x, y)[1];
      sum += off * off;
    });
  return std::sqrt(sum / (kBlock * kBlock * static_cast<double>(blocks.size())));
}

class Study {
 public:
  Study(const SceneDescription& scene, Volume volume) : session_(scene, std::move(volume)) {}

  void make_reference(int spp) {
    reference_ = still(spp, nullptr);
    flip_.emplace(decoded(reference_));
    smooth_ = smooth_blocks(reference_);
  }

  /// The still of so many samples, denoised alone.
  Json still_error(int spp) {
    PictureDenoiser denoiser(scene().render.denoise);
    return {{"spp", spp}, {"error", error(still(spp, &denoiser))}};
  }

  /// After `turning` frames of a turn and `standing` ones that show the scene.
  Json moving_error(double shrink, int turning, int standing) {
    const ImageDescription full = scene().image;
    PictureDenoiser denoiser(scene().render.denoise);
    Image last;
    for (int i = 0; i < turning + standing; ++i) {
      SceneDescription frame = scene();
      frame.image.width = static_cast<int>(std::lround(full.width / shrink));
      frame.image.height = static_cast<int>(std::lround(full.height / shrink));
      frame.render.frame += i + 1;
      frame.camera.azimuth_deg -= 2.0 * std::max(0, turning - 1 - i);
      session_.compile(std::move(frame));
      last = traced(1, &denoiser);
    }
    return {{"shrink", shrink},
            {"turning", turning},
            {"standing", standing},
            {"error", error(on_screen(last, scene(), full.width, full.height))}};
  }

 private:
  const SceneDescription& scene() const { return session_.description(); }

  Image traced(int spp, PictureDenoiser* denoiser) {
    SceneView view = session_.compiled().view();
    FilmLayers layers = denoiser_layers(scene().render.denoise);
    layers.depth = true;
    view.keeps_parts = layers.classes;
    RenderState state{Film(view.width, view.height, layers), {}, 0};
    RenderLoopOptions loop;
    loop.stop.spp = spp;
    if (layers.classes) loop.first_run = std::min(spp, kClassifiedTogether);
    const auto trace = [&](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
      render_tile(view, tile, begin, end, film, counters);
    };
    run_render_loop(state, trace, loop);
    return finish_picture(state, session_.compiled(), {}, {}, denoiser);
  }
  Image still(int spp, PictureDenoiser* denoiser) {
    session_.compile(scene());
    return on_screen(traced(spp, denoiser), scene(), scene().image.width, scene().image.height);
  }

  Json error(const Image& screen) const {
    return {{"flip", flip_->compare(decoded(screen)).mean},
            {"rms", rms(screen, reference_, whole(reference_))},
            {"smooth", rms(screen, reference_, smooth_)}};
  }

  Session session_;
  Image reference_;
  std::vector<Block> smooth_;
  std::optional<FlipReference> flip_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 6) {
    std::fprintf(stderr, "usage: voxlume_first_still VOLUME PRESET [DENOISER [WIDTHxHEIGHT [SPP]]]\n");
    return 2;
  }
  try {
    SceneDescription scene;
    scene.volume.path = argv[1];
    scene.transfer.preset = argv[2];
    scene.render.denoise = argc > 3 ? argv[3] : "decoupled";
    scene.image.width = 768;
    scene.image.height = 576;
    if (argc > 4) std::sscanf(argv[4], "%dx%d", &scene.image.width, &scene.image.height);
    Study study(scene, open_volume(scene.volume));
    study.make_reference(argc > 5 ? std::atoi(argv[5]) : 512);
    Json out{{"preset", argv[2]},
             {"denoiser", scene.render.denoise},
             {"moving", Json::array()},
             {"stills", Json::array()}};
    for (const double shrink : {1.5, 2.0, 3.0, 4.0})
      for (const auto& [turning, standing] : {std::pair{1, 0}, {20, 0}, {20, 10}})
        out["moving"].push_back(study.moving_error(shrink, turning, standing));
    for (const int spp : {1, 3, 7, 15, 31}) out["stills"].push_back(study.still_error(spp));
    std::printf("%s\n", out.dump().c_str());
  } catch (const Error& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
