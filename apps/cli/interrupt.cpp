#include "cli/interrupt.h"

#include <unistd.h>
#include <csignal>

#include "cli/commands.h"

namespace voxlume::cli {
namespace {

// Signal handlers reach nothing but globals.
std::atomic<bool> g_deferred{false}, g_interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free);

void on_signal(int) {
  if (!g_deferred || g_interrupted.exchange(true)) ::_exit(kInterrupted);
}

void set_handler(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  ::sigaction(SIGHUP, &action, nullptr);  // the terminal or the connection went away
}

}  // namespace

InterruptGuard::InterruptGuard() { set_handler(on_signal); }
InterruptGuard::~InterruptGuard() { set_handler(SIG_DFL); }
void InterruptGuard::defer() { g_deferred = true; }
const std::atomic<bool>& InterruptGuard::flag() const { return g_interrupted; }

}  // namespace voxlume::cli
