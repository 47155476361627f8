#include "volume_io/isolated_read.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <utility>

#include "base/fail.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "volume_io/child_limits.h"
#include "volume_io/child_watch.h"
#include "volume_io/memory_limit.h"
#include "volume_io/read_result.h"
#include "volume_io/staged_read.h"

namespace voxlume {
namespace {

/// A file descriptor, closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }

 private:
  const int number_;
};

void write_all(int to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(to, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

/// The child's whole life. Never returns: exit handlers and destructors of the parent's objects must not run.
[[noreturn]] void run_child(const std::filesystem::path& path, const ReadOptions& options, int voxel_file,
                            int result) {
  std::string line;
  try {
    enter_child_limits(path);
    ReadOptions told = options;
    told.progress = [&, last = 0](double share) mutable {
      const int percent = static_cast<int>(100 * share);
      if (std::exchange(last, percent) != percent) write_all(result, fmt::format("{}\n", percent));
    };
    const auto allocate = [&](std::uint64_t bytes, std::uint64_t working_bytes) {
      allow_voxel_memory(bytes, working_bytes);
      if (ftruncate(voxel_file, static_cast<off_t>(bytes)) != 0) {
        fail(ErrorCode::kOutOfMemory, path, fmt::format("cannot allocate {} bytes of shared memory", bytes));
      }
      void* start = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, voxel_file, 0);
      if (start == MAP_FAILED) fail(ErrorCode::kOutOfMemory, path, fmt::format("cannot map {} bytes", bytes));
      return std::shared_ptr<void>(start, [](void*) {});
    };
    line = encode_volume(read_staged(path, told, allocate));
  } catch (const Error& error) {
    line = encode_error(error);
  } catch (...) {
    _exit(kChildFailed);
  }
  write_all(result, line);
  _exit(0);
}

struct ChildOutcome {
  std::string line;
  int status = 0;  ///< as waitpid gives it; 0 when the child cannot be waited for
  bool timed_out = false;
  bool deadlocked = false;  ///< on a lock another thread held when it was forked: worth another try
};

/// Takes the lines off the front of what the child says: how many percent it has read. What follows them, in
/// one line without an end, is its result.
void take_percents(std::string& said, const Progress& progress) {
  for (std::size_t end; (end = said.find('\n')) != std::string::npos; said.erase(0, end + 1))
    if (progress) progress(0.01 * std::atoi(said.c_str()));
}

int status_at_end(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

/// Takes what the child says until it closes the pipe, or is ended for its time or a deadlock.
ChildOutcome listen_to_child(pid_t child, int result, std::chrono::seconds limit, const Progress& progress) {
  constexpr int kWatchMilliseconds = 1000;
  ChildOutcome outcome;
  DeadlockWatch watch(child);
  const auto deadline = std::chrono::steady_clock::now() + limit;
  char text[4096];
  for (;;) {
    throw_if_cancelled();
    pollfd waiting{result, POLLIN, 0};
    const int ready = poll(&waiting, 1, kWatchMilliseconds);
    if (ready < 0 && errno == EINTR) continue;
    if (ready <= 0) {
      outcome.deadlocked = watch.is_deadlocked() && outcome.line.empty();  // else it is about to end
      outcome.timed_out = std::chrono::steady_clock::now() > deadline;
      if (!outcome.deadlocked && !outcome.timed_out) continue;
      kill(child, SIGKILL);
      break;
    }
    const ssize_t count = read(result, text, sizeof(text));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    outcome.line.append(text, static_cast<std::size_t>(count));
    take_percents(outcome.line, progress);
  }
  return outcome;
}

/// Reads what the child says and waits for its end; one whose result is not wanted any more is ended.
ChildOutcome await_child(pid_t child, int result, std::chrono::seconds limit, const Progress& progress) {
  try {
    ChildOutcome outcome = listen_to_child(child, result, limit, progress);
    outcome.status = status_at_end(child);
    return outcome;
  } catch (...) {
    kill(child, SIGKILL);
    status_at_end(child);
    throw;
  }
}

[[noreturn]] void fail_child(const std::filesystem::path& path, const ChildOutcome& outcome) {
  const std::string name = reader_name(path);
  const bool out_of_time =
      outcome.timed_out || (WIFSIGNALED(outcome.status) && WTERMSIG(outcome.status) == SIGXCPU);
  if (out_of_time) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("the reader of {} did not finish in time (damaged?)", name));
  }
  if (has_sanitizer() && WIFEXITED(outcome.status) && WEXITSTATUS(outcome.status) == kChildSanitizerReport) {
    fail(ErrorCode::kInternal, path,
         fmt::format("a sanitizer stopped the reader of {}; its report is on stderr", name));
  }
  const bool out_of_memory = WIFEXITED(outcome.status) && WEXITSTATUS(outcome.status) == kChildOutOfMemory;
  fail(ErrorCode::kBadFormat, path,
       fmt::format("the reader of {} {} on this file (damaged?)", name,
                   out_of_memory ? "needed far more memory than the header promises" : "failed"));
}

std::shared_ptr<const void> map_result(const std::filesystem::path& path, int voxel_file, std::size_t bytes) {
  // Narrowed integers leave the second half unused.
  const bool is_cut = ftruncate(voxel_file, static_cast<off_t>(bytes)) == 0;
  void* start = is_cut ? mmap(nullptr, bytes, PROT_READ, MAP_SHARED, voxel_file, 0) : MAP_FAILED;
  if (start == MAP_FAILED) fail(ErrorCode::kOutOfMemory, path, fmt::format("cannot map {} bytes", bytes));
  return {start, [bytes](const void* p) { munmap(const_cast<void*>(p), bytes); }};
}

/// Forks a child that reads into `voxel_file` and waits for it.
ChildOutcome read_in_child(const std::filesystem::path& path, const ReadOptions& options, int voxel_file) {
  const std::chrono::seconds limit(wall_limit_seconds(path));
  int ends[2] = {-1, -1};
  pid_t child = -1;
  int reason = 0;
  {
    // The pipe lives within the lock too: another child that held its writing end would keep it open.
    const std::unique_lock lock(library_mutex());
    if (voxel_file >= 0 && pipe2(ends, O_CLOEXEC) == 0) child = fork();
    if (child == 0) run_child(path, options, voxel_file, ends[1]);
    reason = errno;
    const Descriptor to_parent(ends[1]);
  }
  const Descriptor from_child(ends[0]);
  if (child < 0) {
    fail(ErrorCode::kInternal, path, fmt::format("cannot start the reader: {}", std::strerror(reason)));
  }
  return await_child(child, from_child.get(), limit, options.progress);
}

}  // namespace

std::shared_mutex& library_mutex() {
  static std::shared_mutex mutex;
  return mutex;
}

Volume read_isolated(const std::filesystem::path& path, const ReadOptions& options) {
  constexpr int kMaxTries = 5;
  for (int tries = 1;; ++tries) {
    const Descriptor voxel_file(memfd_create("voxlume-voxels", MFD_CLOEXEC));
    const ChildOutcome outcome = read_in_child(path, options, voxel_file.get());
    if (outcome.deadlocked && tries < kMaxTries) continue;
    if (outcome.timed_out || outcome.status != 0 || outcome.line.empty()) fail_child(path, outcome);
    auto [volume, in_file] = decode_result(outcome.line);
    volume.voxels =
        in_file ? map_voxels(*in_file, volume) : map_result(path, voxel_file.get(), volume.byte_count());
    return std::move(volume);
  }
}

Volume read_in_process(const std::filesystem::path& path, const ReadOptions& options) {
  auto [volume, in_file] = read_staged(
      path, options, [&](std::uint64_t bytes, std::uint64_t) { return allocate_voxels(path, bytes); });
  if (in_file) volume.voxels = map_voxels(*in_file, volume);
  return std::move(volume);
}

}  // namespace voxlume
