#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace voxlume {

/// Numbered PNG pictures of one size in a folder.
struct MovieFrames {
  std::filesystem::path folder;
  std::string pattern;  ///< a file name with one %d in it, such as "%06d.png"
  int first = 0, count = 0;
  double fps = 30;
};

/// Whether `path` names a movie that can be made: .mp4 (H.264) or .webm (VP9), in any case.
bool is_movie_name(const std::filesystem::path& path);

/// The ffmpeg program, the first on PATH. Throws Error kUnsupported, saying what to install, where there is
/// none.
std::filesystem::path find_ffmpeg();

/// ffmpeg's arguments, the program's name first, for writing `frames` (relative to their folder) to
/// `output` as `movie` is named. Odd sides lose their last row or column; colours are BT.709 of limited
/// range, 4:2:0.
std::vector<std::string> ffmpeg_arguments(const MovieFrames& frames, const std::filesystem::path& movie,
                                          const std::filesystem::path& output);

/// Encodes a movie, written aside and renamed. A Ctrl-C at the terminal ends ffmpeg as well. Throws Error
/// kInternal with what ffmpeg said where it fails.
void encode_movie(const std::filesystem::path& ffmpeg, const MovieFrames& frames,
                  const std::filesystem::path& movie);

}  // namespace voxlume
