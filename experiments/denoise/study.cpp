// Renders animated sequences with few samples, denoises them by every method and compares them with
// references of many samples. Writes one CSV a sequence into a folder; what is there already is left alone.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>

#include "denoise/denoiser.h"
#include "image_io/image_io.h"
#include "metrics/flip.h"
#include "metrics/metrics.h"
#include "render/denoise_frame.h"
#include "render/film_image.h"
#include "sequences.h"
#include "tonemap/tone_map.h"
#include "voxlume/error.h"

namespace fs = std::filesystem;
using namespace voxlume;
using namespace voxlume::study;

namespace {

struct Options {
  fs::path folder;
  int width = 320, height = 180, frames = 120, every = 4, reference_spp = 512;
  std::vector<int> spp{2, 30};
  std::vector<std::string> data{"head-ct", "mri-head"}, animations, methods;
};

/// Frames that an animation takes; a shorter study shows its beginning at the same speed.
constexpr double kFramesOfATurn = 120;

double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// The reference of a frame, kept on disk.
Image reference(const Options& o, const CompiledScene& scene, const std::string& sequence, int frame) {
  const fs::path path = o.folder / "references" / fmt::format("{}-{:04d}.exr", sequence, frame);
  if (fs::exists(path)) return read_image(path);
  const Image image =
      image_from_film(render_frame(scene, o.reference_spp, 1000000u + frame, false), {}, false);
  fs::create_directories(path.parent_path());
  write_exr(image, path);
  return image;
}

/// As a display shows it, for the page.
void write_display(const Options& o, const Image& picture, const std::string& name) {
  fs::create_directories(o.folder / "pictures");
  write_png(tone_map(picture, {.dither = false}), o.folder / "pictures" / (name + ".png"));
}

struct Method {
  std::string name;
  std::unique_ptr<Denoiser> denoiser;  ///< null: the noisy picture itself
  DenoisedFrame out;
};

void run_sequence(const Options& o, const Dataset& data, const Animation& animation, int spp) {
  const std::string sequence = data.name + "-" + animation.name;
  const fs::path path = o.folder / fmt::format("{}-{}spp.csv", sequence, spp);
  if (fs::exists(path)) return;
  std::vector<Method> methods;
  methods.push_back({"noisy", nullptr, {}});
  for (const DenoiserKind& kind : denoiser_kinds()) {
    const bool chosen = o.methods.empty() || std::count(o.methods.begin(), o.methods.end(), kind.name) > 0;
    if (chosen) methods.push_back({std::string(kind.name), kind.make(), {}});
  }
  std::string csv = "data,animation,spp,frame,method,rmse,psnr_db,psnr_hdr_db,ssim,flip,ms\n";
  DenoiseFrame frame;
  std::map<std::string, std::pair<double, double>> sums;
  int compared = 0;
  for (int f = 0; f < o.frames; ++f) {
    const auto scene = compile_frame(data, animation, f / kFramesOfATurn, 1);
    fill_denoise_frame(render_frame(*scene, spp, static_cast<std::uint32_t>(f), true), scene->view(),
                       data.size_mm, frame);
    const bool compares = f % o.every == o.every - 1;
    Image exact;
    if (compares) exact = reference(o, *scene, sequence, f), ++compared;
    for (Method& method : methods) {
      const double begin = now_ms();
      if (method.denoiser) {
        method.denoiser->denoise(frame, method.out);
      } else {
        method.out.radiance = frame.radiance;
        method.out.alpha = frame.alpha;
      }
      const double ms = now_ms() - begin;
      if (!compares) continue;
      const Image picture = compose_picture(frame, method.out, false);
      const double psnr_db = psnr(picture, exact).value_or(99), flip_mean = flip(picture, exact).mean;
      csv +=
          fmt::format("{},{},{},{},{},{:.6g},{:.4f},{:.4f},{:.5f},{:.5f},{:.2f}\n", data.name, animation.name,
                      spp, f, method.name, rmse(picture, exact), psnr_db,
                      psnr_hdr(picture, exact).value_or(99), ssim(picture, exact).value_or(1), flip_mean, ms);
      sums[method.name].first += psnr_db;
      sums[method.name].second += flip_mean;
      if (f + o.every >= o.frames) {
        fs::create_directories(o.folder / "pictures");
        write_exr(picture,
                  o.folder / "pictures" / fmt::format("{}-{}spp-{}.exr", sequence, spp, method.name));
      }
    }
    if (compares && f + o.every >= o.frames) write_display(o, exact, sequence + "-reference");
    fmt::print(stderr, "\r{} {} spp: frame {}/{} ", sequence, spp, f + 1, o.frames);
  }
  fmt::print(stderr, "\n");
  for (const Method& m : methods)
    fmt::print("{:24s} {:2d} spp {:14s} PSNR {:.2f} dB  FLIP {:.4f}\n", sequence, spp, m.name,
               sums[m.name].first / compared, sums[m.name].second / compared);
  std::fflush(stdout);
  std::ofstream(path) << csv;
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  CLI::App app("Study of the denoisers");
  app.add_option("FOLDER", o.folder)->required();
  app.add_option("--width", o.width);
  app.add_option("--height", o.height);
  app.add_option("--frames", o.frames);
  app.add_option("--every", o.every, "Frames from one that is compared to the next");
  app.add_option("--reference-spp", o.reference_spp);
  app.add_option("--spp", o.spp)->delimiter(',');
  app.add_option("--data", o.data)->delimiter(',');
  app.add_option("--animations", o.animations)->delimiter(',');
  app.add_option("--methods", o.methods)->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  try {
    fs::create_directories(o.folder);
    for (const std::string& name : o.data) {
      const bool ct = name == "head-ct";
      const Dataset data = load_dataset(name, ct ? "data/head-ct.nrrd" : "data/mri-head.nii.gz",
                                        ct ? "ct-bone" : "mri-head", o.width, o.height);
      for (const Animation& animation : animations()) {
        const bool chosen =
            o.animations.empty() || std::count(o.animations.begin(), o.animations.end(), animation.name) > 0;
        for (const int spp : o.spp)
          if (chosen) run_sequence(o, data, animation, spp);
      }
    }
  } catch (const Error& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}
