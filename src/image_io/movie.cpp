#include "image_io/movie.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "base/atomic_file.h"
#include "base/fail.h"
#include "base/file_extension.h"

extern char** environ;

namespace voxlume {
namespace {

namespace fs = std::filesystem;

/// Everything that can be read from `descriptor` until it is closed; the first 64 KiB are kept.
std::string read_all(int descriptor) {
  std::string text;
  char block[4096];
  for (;;) {
    const ssize_t count = ::read(descriptor, block, sizeof block);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    if (text.size() < 65536) text.append(block, static_cast<std::size_t>(count));
  }
}

/// Runs a program in `folder` with an empty input. Returns its status as waitpid gives it and what it wrote
/// to standard error.
std::pair<int, std::string> run_program(const fs::path& program, const std::vector<std::string>& arguments,
                                        const fs::path& folder) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) fail(ErrorCode::kInternal, program, std::strerror(errno));
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  pid_t child = -1;
  const int failed = ::posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  const std::string said = failed ? "" : read_all(ends[0]);
  ::close(ends[0]);
  if (failed) fail(ErrorCode::kInternal, program, std::string("cannot be started: ") + std::strerror(failed));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return {status, said};
}

}  // namespace

bool is_movie_name(const fs::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".mp4" || extension == ".webm";
}

fs::path find_ffmpeg() {
  const char* const list = std::getenv("PATH");
  std::string_view rest = list ? list : "";
  while (!rest.empty()) {
    const std::size_t end = std::min(rest.find(':'), rest.size());
    const fs::path program = fs::path(rest.substr(0, end)) / "ffmpeg";
    std::error_code ignored;
    if (end > 0 && fs::is_regular_file(program, ignored) && ::access(program.c_str(), X_OK) == 0)
      return fs::absolute(program);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  throw Error(ErrorCode::kUnsupported, "",
              "movies are written by ffmpeg, which is not installed (Debian, Ubuntu: apt install ffmpeg); or "
              "write numbered pictures, such as -o frame-####.png");
}

std::vector<std::string> ffmpeg_arguments(const MovieFrames& frames, const fs::path& movie,
                                          const fs::path& output) {
  const bool webm = lower_extension(movie) == ".webm";
  std::vector<std::string> out{"ffmpeg", "-nostdin", "-hide_banner", "-loglevel", "error", "-y"};
  const auto add = [&](std::initializer_list<std::string> words) { out.insert(out.end(), words); };
  add({"-framerate", fmt::format("{}", frames.fps), "-start_number", std::to_string(frames.first)});
  add({"-i", frames.pattern, "-frames:v", std::to_string(frames.count)});
  // Colours at half the resolution need even sides.
  add({"-vf",
       "crop=trunc(iw/2)*2:trunc(ih/2)*2:0:0,scale=out_color_matrix=bt709:out_range=tv,format=yuv420p"});
  add({"-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"});
  if (webm) {
    add({"-c:v", "libvpx-vp9", "-crf", "20", "-b:v", "0", "-row-mt", "1", "-f", "webm"});
  } else {
    add({"-c:v", "libx264", "-crf", "16", "-preset", "slow", "-movflags", "+faststart", "-f", "mp4"});
  }
  add({fs::absolute(output).string()});
  return out;
}

void encode_movie(const fs::path& ffmpeg, const MovieFrames& frames, const fs::path& movie) {
  write_file_atomically(movie, [&](const fs::path& temporary) {
    const auto [status, said] =
        run_program(ffmpeg, ffmpeg_arguments(frames, movie, temporary), frames.folder);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && fs::exists(temporary)) return;
    fail(ErrorCode::kInternal, movie,
         "ffmpeg could not write it: " + (said.empty() ? "no reason given" : said));
  });
}

}  // namespace voxlume
