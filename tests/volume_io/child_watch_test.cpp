#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <mutex>

#include "volume_io/child_watch.h"

namespace voxlume::test {
namespace {

/// Forks a child that runs `act` for ever, asks the watch `calls` times and ends the child.
template <typename Act>
bool is_found_deadlocked(Act&& act, int calls) {
  const pid_t child = fork();
  if (child == 0) {
    for (;;) act();
  }
  DeadlockWatch watch(child);
  bool found = false;
  for (int i = 0; i < calls && !found; ++i) {
    usleep(100'000);
    found = watch.is_deadlocked();
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  return found;
}

/// Work that is the system's for the most part.
void read_nothing() {
  static const int file = open("/dev/null", O_RDONLY);
  char byte = 0;
  (void)!read(file, &byte, 1);
}

void touch_memory() {
  constexpr std::size_t kBytes = 1 << 20;
  void* start = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  for (std::size_t i = 0; i < kBytes; i += 4096) static_cast<volatile char*>(start)[i] = 1;
  munmap(start, kBytes);
}

TEST(ChildWatch, TellsALockHeldForEverFromWorkAndFromWaiting) {
  static std::mutex mutex;
  mutex.lock();
  EXPECT_TRUE(is_found_deadlocked([] { mutex.lock(); }, 20));
  mutex.unlock();
  EXPECT_TRUE(is_found_deadlocked([] { sched_yield(); }, 100));
  EXPECT_FALSE(is_found_deadlocked([count = 0]() mutable { const_cast<volatile int&>(count) = 1; }, 8));
  EXPECT_FALSE(is_found_deadlocked(read_nothing, 8));
  EXPECT_FALSE(is_found_deadlocked(touch_memory, 8));
  EXPECT_FALSE(is_found_deadlocked([] { pause(); }, 8));
}

}  // namespace
}  // namespace voxlume::test
