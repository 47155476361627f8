#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "methods.h"
#include "sequences.h"

namespace voxlume::study {

/// How large a study is.
struct Options {
  std::filesystem::path folder;
  int width = 320, height = 180;
  int frames = 120, every = 4;  ///< every so many frames one is compared
  int warm_up = 0;              ///< frames rendered before one that is compared; 0: all
  int reference_spp = 512;
  std::vector<int> spp{2, 30};
  std::vector<std::string> data{"head-ct", "mri-head"}, media{"semi-transparent", "homogeneous"};
  int media_frames = 32;
  std::vector<std::string> animations;     ///< empty: all
  std::vector<int> moments{30};            ///< frames at which steadiness is measured
  int history = 12, seeds = 6, rest = 12;  ///< frames before such a moment, pictures of it, frames after it
  int neural_every = 4;                    ///< of the compared frames, since it is slow
  std::vector<int> sweep{1, 2, 4, 8, 16, 30, 60};
  std::string environment;  ///< a picture; empty: constant
  bool all_methods = false;
};

/// A picture of many samples a pixel, and what is known of its own noise.
struct Reference {
  Image image;
  double floor_db;    ///< PSNR to the truth, from how far its two halves are from one another
  double floor_flip;  ///< FLIP between its halves, which is more than that to the truth
};

/// The reference of where `sequence` stands; kept on disk and read when it is there.
Reference reference(const Options& options, const Sequence& sequence, int frame);

/// As a display shows it: a PNG for the page.
void write_display(const Options& options, const Image& picture, const std::string& name);

/// Rows of a table that becomes a file when all are there, so that what exists is whole.
class Table {
 public:
  Table(const Options& options, const std::string& name, const std::string& columns);
  void add(const std::string& row) { text_ += row + '\n'; }
  void write() const;

 private:
  std::filesystem::path path_;
  std::string text_;
};

/// Whether a study left the table of that name before.
bool has_table(const Options& options, const std::string& name);

/// Runs `body` with every data set and animation chosen of which there is no table called
/// `table`-DATA-ANIMATION yet.
void for_each_sequence(const Options& options, const std::string& table,
                       const std::function<void(const Dataset& data, const Animation& animation)>& body);

// The parts of the study; each leaves alone what is there.

/// PSNR, FLIP and SSIM of every method, frame by frame, over every sequence; ghosting; ablations.
void compare_over_time(const Options& options);
/// How much pictures of one moment differ, and how soon pictures stop changing once nothing moves.
void measure_steadiness(const Options& options);
/// Samples a pixel against frames a second and PSNR.
void sweep_samples(const Options& options);
/// A camera at rest, so that nothing but noise moves.
void stand_still_study(const Options& options);
/// Pictures of the parts of light, and the error of the product of means over 1, 2 and 3 classes.
void show_parts(const Options& options);

}  // namespace voxlume::study
