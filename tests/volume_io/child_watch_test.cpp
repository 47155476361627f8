#include <gtest/gtest.h>
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
    usleep(50'000);
    found = watch.is_deadlocked();
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  return found;
}

TEST(ChildWatch, TellsALockHeldForEverFromWorkAndFromWaiting) {
  static std::mutex mutex;
  mutex.lock();
  EXPECT_TRUE(is_found_deadlocked([] { mutex.lock(); }, 20));
  mutex.unlock();
  EXPECT_FALSE(is_found_deadlocked([] {}, 8));
  EXPECT_FALSE(is_found_deadlocked([] { pause(); }, 8));
}

}  // namespace
}  // namespace voxlume::test
