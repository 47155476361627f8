#include "volume_io/child_watch.h"

#include <fmt/format.h>
#include <sys/syscall.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

namespace voxlume {
namespace {

using Sight = DeadlockWatch::Sight;

/// The system call the child is in with its arguments, when it is a wait for a lock; else empty.
std::string lock_wait(const std::string& folder) {
  std::ifstream file(folder + "/syscall");
  std::string line;
  if (!std::getline(file, line) || !line.starts_with(fmt::format("{} ", SYS_futex))) return {};
  return line;
}

std::string whole_file(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

Sight look_at(const std::string& folder) {
  Sight out{.lock_wait = lock_wait(folder), .io = whole_file(folder + "/io")};
  const std::string stat = whole_file(folder + "/stat");
  const std::size_t name_end = stat.rfind(')');
  if (name_end == std::string::npos) return {};
  std::istringstream fields(stat.substr(name_end + 1));
  std::string state, skipped;
  fields >> state;
  out.runs = state == "R";
  constexpr int kFieldsBefore = 6;  // ppid to flags; minflt, cminflt, majflt, cmajflt, utime, stime follow
  for (int i = 0; i < kFieldsBefore; ++i) fields >> skipped;
  std::uint64_t minor = 0, major = 0;
  fields >> minor >> skipped >> major >> skipped >> out.user_ticks >> out.system_ticks;
  out.faults = minor + major;
  std::istringstream times(whole_file(folder + "/schedstat"));  // not on every system
  times >> skipped >> skipped >> out.turns;
  return out;
}

/// Neither read nor wrote nor touched new memory.
bool is_idle(const Sight& before, const Sight& now) {
  return now.io == before.io && now.faults == before.faults;
}

/// Blocked in one wait for a lock.
bool is_same_wait(const Sight& before, const Sight& now) {
  return !now.lock_wait.empty() && now.lock_wait == before.lock_wait && now.user_ticks == before.user_ticks &&
         now.system_ticks == before.system_ticks;
}

/// Asks the system again and again for nothing, or gets no processor.
bool only_yields(const Sight& before, const Sight& now) {
  return now.runs && !now.io.empty() &&
         now.system_ticks - before.system_ticks >= now.user_ticks - before.user_ticks;
}

/// Got the processor for a while or, on a busy machine, which yielding hands it to, many times.
bool has_run(const Sight& before, const Sight& now) {
  constexpr std::uint64_t kEnoughTicks = 10, kEnoughTurns = 100;
  return now.system_ticks - before.system_ticks >= kEnoughTicks || now.turns - before.turns >= kEnoughTurns;
}

}  // namespace

DeadlockWatch::DeadlockWatch(pid_t child) : folder_(fmt::format("/proc/{}", child)) {}

bool DeadlockWatch::is_deadlocked() {
  constexpr int kEnoughCalls = 4;
  Sight now = look_at(folder_);
  const bool waits = is_idle(since_, now) && is_same_wait(since_, now);
  const bool yields = is_idle(since_, now) && only_yields(since_, now);
  calls_ = waits || yields ? calls_ + 1 : 0;
  if (calls_ == 0) since_ = std::move(now);
  return calls_ >= kEnoughCalls && (waits || has_run(since_, now));
}

}  // namespace voxlume
