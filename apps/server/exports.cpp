#include "server/exports.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <cstring>
#include <fstream>
#include <thread>

#include "base/fail.h"
#include "base/file_extension.h"
#include "image_io/movie.h"
#include "scene/animation.h"
#include "scene/scene_file.h"
#include "server/uploads.h"
#include "server/zip_file.h"

extern char** environ;

namespace voxlume::server {

namespace fs = std::filesystem;
namespace asio = boost::asio;

namespace {

constexpr auto kLookEvery = std::chrono::milliseconds(250);
/// The least priority: while something moves on screen, the picture takes all that it needs. A still picture
/// yields (LiveSession::set_yielding).
constexpr int kNice = 19;

std::vector<fs::path> pictures_in(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code failed;
  for (auto it = fs::directory_iterator(folder, failed); !failed && it != fs::directory_iterator();
       it.increment(failed))
    if (it->path().extension() == ".png" && !it->path().filename().string().starts_with('.'))
      out.push_back(it->path());
  std::sort(out.begin(), out.end());
  return out;
}

/// What the program said last on standard error.
std::string last_line(const fs::path& log) {
  std::ifstream file(log);
  std::string line, last;
  while (std::getline(file, line))
    if (!line.empty()) last = line;
  constexpr std::string_view kPrefix = "error: ";
  return one_line(last.starts_with(kPrefix) ? last.substr(kPrefix.size()) : last);
}

pid_t spawn(const std::vector<std::string>& arguments, const fs::path& folder) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  const std::string log = folder / "log";
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addclosefrom_np(&actions, STDERR_FILENO + 1);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // its own, so that ffmpeg ends with it
  pid_t child = -1;
  const int failed = ::posix_spawn(&child, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (failed)
    fail(ErrorCode::kInternal, arguments.front(), std::string("cannot be started: ") + std::strerror(failed));
  ::setpriority(PRIO_PGRP, static_cast<id_t>(child), kNice);  // of a process, it would be that of one thread
  return child;
}

}  // namespace

Exports::Exports(asio::io_context& io, fs::path program, fs::path folder,
                 std::function<void(const nlohmann::json&)> told)
    : io_(io), program_(std::move(program)), folder_(std::move(folder)), told_(std::move(told)), timer_(io) {}

void Exports::end() {
  zipping_.join();
  if (!job_ || job_->process <= 0) return;
  ::kill(-job_->process, SIGKILL);  // nobody will ask for what it has
  ::waitpid(job_->process, nullptr, 0);
  job_.reset();
}

void Exports::start(SceneDescription scene, const std::string& file) {
  const auto refuse = [](const std::string& message) {
    throw Error(ErrorCode::kBadParameter, "/file", message);
  };
  const bool zip = lower_extension(file) == ".zip";
  if (!is_plain_file_name(file) || (!zip && !is_movie_name(file)))
    refuse("expected a file name that ends in .mp4, .webm or .zip");
  if (job_) refuse(job_->file + " is being rendered; wait for it, or cancel it");
  if (!scene.animation) refuse("the scene stands still; give it a turntable or tracks");
  if (!zip) find_ffmpeg();
  Job job;
  job.file = file;
  job.frame_count = frame_count(*scene.animation);
  job.folder = folder_ / std::to_string(++count_);
  job.frames = zip ? job.folder / "pictures" : job.folder / (file + ".frames");
  job.output = job.folder / file;
  fs::create_directories(zip ? job.frames : job.folder);
  const fs::path scene_file = job.folder / "scene.json";
  save_scene(scene, scene_file);
  const std::string stem = fs::path(file).stem().string();
  const bool has_pattern = stem.find('#') != std::string::npos;
  const fs::path target = zip ? job.frames / ((has_pattern ? "frame" : stem) + "-####.png") : job.output;
  job.process = spawn({program_.string(), "render", scene_file.string(), "-o", target.string()}, job.folder);
  job_ = std::move(job);
  tell("running");
  watch();
}

void Exports::cancel() {
  if (!job_) return;
  job_->cancelled = true;
  if (job_->process > 0) ::kill(-job_->process, SIGINT);
}

void Exports::watch() {
  timer_.expires_after(kLookEvery);
  timer_.async_wait([this](boost::system::error_code failed) {
    if (!failed && job_) look();
  });
}

void Exports::look() {
  int status = 0;
  if (::waitpid(job_->process, &status, WNOHANG) == 0) {
    tell("running");
    return watch();
  }
  job_->process = -1;
  ended(status);
}

void Exports::ended(int status) {
  if (job_->cancelled) return finish("cancelled");
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    const std::string said = last_line(job_->folder / "log");
    return finish("failed", said.empty() ? "the program that renders it ended" : said);
  }
  if (lower_extension(job_->file) == ".zip") return zip();
  finish("done");
}

void Exports::zip() {
  asio::post(zipping_, [this, frames = job_->frames, output = job_->output] {
    std::string message;
    try {
      write_zip(pictures_in(frames), output);
    } catch (const std::exception& error) {
      message = error.what();
    }
    asio::post(io_, [this, message] {
      if (!job_) return;
      if (job_->cancelled) return finish("cancelled");
      message.empty() ? finish("done") : finish("failed", message);
    });
  });
}

void Exports::finish(const std::string& state, const std::string& message) {
  tell(state, message);
  std::error_code ignored;
  if (state == "done") {
    if (const fs::path before = finished(job_->file); !before.empty()) fs::remove(before, ignored);
    finished_[job_->file] = job_->output;
    fs::remove_all(job_->frames, ignored);
  } else {
    fs::remove_all(job_->folder, ignored);
  }
  job_.reset();
}

fs::path Exports::finished(const std::string& file) const {
  const auto found = finished_.find(file);
  return found == finished_.end() ? fs::path() : found->second;
}

void Exports::tell(const std::string& state, const std::string& message) {
  const int done = state == "done" ? job_->frame_count : static_cast<int>(pictures_in(job_->frames).size());
  state_ = {{"type", "export"},
            {"state", state},
            {"frames_done", done},
            {"frames", job_->frame_count},
            {"file", job_->file}};
  if (!message.empty()) state_["message"] = message;
  told_(state_);
}

}  // namespace voxlume::server
