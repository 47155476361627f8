#pragma once
#include <sys/types.h>

#include <cstdint>
#include <string>

namespace voxlume {

/// Notices a child that can never go on: it has one thread, and that thread waits for a lock which another
/// thread of the parent held at the moment of the fork. (The C library's own locks survive a fork, those of
/// other libraries and of the sanitizers do not; the latter are waited for by yielding the processor for
/// ever.)
class DeadlockWatch {
 public:
  explicit DeadlockWatch(pid_t child);
  /// To be called about once a second. True after several calls in a row that found the child in the same
  /// wait with no processor time used in between, or in system calls alone which neither read nor wrote nor
  /// touched new memory; never true where the system does not tell.
  bool is_deadlocked();

  /// What of a process tells a wait for ever from work.
  struct Sight {
    bool runs = false;      ///< or would, if it had a processor
    std::string lock_wait;  ///< the system call it is in with its arguments, where that waits for a lock
    std::string io;         ///< what it has read and written
    std::uint64_t faults = 0, user_ticks = 0, system_ticks = 0;
    std::uint64_t turns = 0;  ///< how often it got a processor; 0 where that is not known
  };

 private:
  std::string folder_;
  Sight since_;    ///< nothing but waiting was seen from then on
  int calls_ = 0;  ///< from then on
};

}  // namespace voxlume
