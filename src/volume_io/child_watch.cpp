#include "volume_io/child_watch.h"

#include <fmt/format.h>
#include <sys/syscall.h>

#include <fstream>
#include <sstream>

namespace voxlume {
namespace {

/// The processor time fields of /proc/PID/stat; empty when it cannot be read.
std::string processor_time(const std::string& folder) {
  std::ifstream file(folder + "/stat");
  std::string line;
  if (!std::getline(file, line)) return {};
  const std::size_t name_end = line.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream fields(line.substr(name_end + 1));
  std::string word;
  constexpr int kFieldsBefore = 11;  // state to cmajflt; utime and stime follow
  for (int i = 0; i < kFieldsBefore; ++i) fields >> word;
  std::string user;
  std::string system;
  fields >> user >> system;
  return user + " " + system;
}

/// The system call the child is in with its arguments, when it is a wait for a lock; else empty.
std::string lock_wait(const std::string& folder) {
  std::ifstream file(folder + "/syscall");
  std::string line;
  if (!std::getline(file, line) || !line.starts_with(fmt::format("{} ", SYS_futex))) return {};
  return line;
}

}  // namespace

DeadlockWatch::DeadlockWatch(pid_t child) : folder_(fmt::format("/proc/{}", child)) {}

bool DeadlockWatch::is_deadlocked() {
  constexpr int kEnoughRepeats = 4;
  const std::string wait = lock_wait(folder_);
  const std::string seen = wait.empty() ? "" : wait + " " + processor_time(folder_);
  repeats_ = !seen.empty() && seen == last_seen_ ? repeats_ + 1 : 0;
  last_seen_ = seen;
  return repeats_ >= kEnoughRepeats;
}

}  // namespace voxlume
