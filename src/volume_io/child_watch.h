#pragma once
#include <sys/types.h>

#include <string>

namespace voxlume {

/// Notices a child that can never go on: it has one thread, and that thread waits for a lock which another
/// thread of the parent held at the moment of the fork. (The C library's own locks survive a fork, those of
/// other libraries and of the sanitizers' allocators do not.)
class DeadlockWatch {
 public:
  explicit DeadlockWatch(pid_t child);
  /// To be called about once a second. True after several calls in a row that found the child in the same
  /// wait, with no processor time used in between; never true where the system does not tell.
  bool is_deadlocked();

 private:
  std::string folder_;
  std::string last_seen_;
  int repeats_ = 0;
};

}  // namespace voxlume
