// Renders animated sequences with few samples, denoises them by every method and compares them with
// references of many samples; measures steadiness, convergence, ablations. Leaves CSVs and pictures in a
// folder, from which tools/experiments/denoise_page.py makes the page; what is there already is left alone.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "study.h"
#include "voxlume/error.h"

using namespace voxlume;
using namespace voxlume::study;

namespace {

/// The papers' sizes: pictures of xu2024 (1440 x 1190) and references of both (1024 samples); a history of 29
/// frames would take more memory than twelve are worth.
void make_full(Options& o) {
  o.width = 1440;
  o.height = 1190;
  o.reference_spp = 1024;
  o.media_frames = o.frames;
  o.moments = {20, 40, 75, 100};
  o.seeds = 50;
  o.rest = 40;
  o.neural_every = 1;
  o.all_methods = true;
}

using Part = void (*)(const Options&);
const std::vector<std::pair<std::string, Part>> kParts{{"steadiness", measure_steadiness},
                                                       {"parts", show_parts},
                                                       {"sweep", sweep_samples},
                                                       {"still", stand_still_study},
                                                       {"over-time", compare_over_time}};

/// What the pictures are of, for the page.
void note_settings(const Options& o) {
  std::ofstream file(o.folder / "settings.txt");
  file << fmt::format("{} x {} pixels, {} frames a sequence", o.width, o.height, o.frames);
  if (!o.media.empty()) file << fmt::format(" ({} of other media)", o.media_frames);
  file << fmt::format(", every {}th compared with {} samples a pixel", o.every, o.reference_spp);
  if (o.warm_up > 0) file << fmt::format(" after {} frames of history, the only others rendered", o.warm_up);
  file << ". Camera zoom 1. One area light that stands still in the world, and "
       << (o.environment.empty() ? "a constant environment" : "the environment picture " + o.environment)
       << fmt::format(". Steadiness: {} frames of history, {} pictures of the moment, {} frames at rest.\n",
                      o.history, o.seeds, o.rest);
}

/// Everything that tables and references depend on, one option a line; which sequences and parts there are is
/// free to change from run to run.
std::string options_text(const Options& o) {
  return fmt::format(
      "width {}\nheight {}\nframes {}\nmedia-frames {}\nevery {}\nwarm-up {}\nneural-every {}\nreference-spp "
      "{}\nspp {}\n"
      "moments {}\nhistory {}\nseeds {}\nrest {}\nsweep {}\nenvironment {}\nall-methods {}\n",
      o.width, o.height, o.frames, o.media_frames, o.every, o.warm_up, o.neural_every, o.reference_spp,
      fmt::join(o.spp, ","), fmt::join(o.moments, ","), o.history, o.seeds, o.rest, fmt::join(o.sweep, ","),
      o.environment.empty() ? "constant" : o.environment, o.all_methods);
}

/// A folder goes on as it began: what is there would else pass for a result of other settings.
void claim_folder(const Options& o) {
  const std::filesystem::path path = o.folder / "options.txt";
  std::filesystem::create_directories(o.folder);
  if (!std::filesystem::exists(path)) {
    for (const auto& entry : std::filesystem::directory_iterator(o.folder)) {
      if (entry.path().extension() != ".csv" && entry.path().filename() != "references") continue;
      throw Error(ErrorCode::kBadParameter, o.folder.string(),
                  "has results of unknown options (no options.txt); use another folder or remove it");
    }
    std::ofstream(path) << options_text(o);
    return;
  }
  std::ifstream there(path);
  std::istringstream now(options_text(o));
  std::string before, wanted;
  while (std::getline(now, wanted)) {
    if (std::getline(there, before) && before == wanted) continue;
    throw Error(
        ErrorCode::kBadParameter, o.folder.string(),
        fmt::format("has results of other options (--{} there, --{} now); use another folder or remove it",
                    before, wanted));
  }
}

/// Seconds that parts took, one line for each that did something.
void note_time(const Options& o, const std::string& part, double seconds) {
  constexpr double kNothingToDo = 3;
  if (seconds < kNothingToDo) return;
  std::ofstream(o.folder / "seconds.csv", std::ios::app) << fmt::format("{},{:.1f}\n", part, seconds);
}

}  // namespace

int main(int argc, char** argv) {
  Options o;
  bool full = false;
  // The other options change what it sets.
  if (std::find(argv, argv + argc, std::string_view("--full")) != argv + argc) make_full(o);
  std::vector<std::string> parts;
  CLI::App app("Study of the denoisers");
  app.add_option("FOLDER", o.folder)->required();
  app.add_flag("--full", full, "The papers' sizes; other options change them");
  app.add_option("--width", o.width);
  app.add_option("--height", o.height);
  app.add_option("--frames", o.frames);
  app.add_option("--every", o.every, "Frames from one that is compared to the next");
  app.add_option("--warm-up", o.warm_up, "Frames rendered before one that is compared; 0: all");
  app.add_option("--neural-every", o.neural_every, "Of the compared frames");
  app.add_option("--reference-spp", o.reference_spp);
  app.add_option("--spp", o.spp)->delimiter(',');
  app.add_option("--data", o.data)->delimiter(',');
  app.add_option("--media", o.media, "\"none\": no other media")->delimiter(',');
  app.add_option("--media-frames", o.media_frames);
  app.add_option("--animations", o.animations)->delimiter(',');
  app.add_option("--moments", o.moments)->delimiter(',');
  app.add_option("--history", o.history);
  app.add_option("--seeds", o.seeds);
  app.add_option("--rest", o.rest);
  app.add_option("--sweep", o.sweep, "Samples a pixel")->delimiter(',');
  app.add_option("--environment", o.environment, "A picture; without one it is constant");
  app.add_option("--parts", parts, "over-time, steadiness, parts, sweep, still; all when absent")
      ->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  if (o.media == std::vector<std::string>{"none"}) o.media.clear();
  try {
    claim_folder(o);
    note_settings(o);
    for (const auto& [name, run] : kParts) {
      if (!parts.empty() && std::ranges::find(parts, name) == parts.end()) continue;
      const auto begin = std::chrono::steady_clock::now();
      run(o);
      note_time(o, name, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
  } catch (const Error& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}
