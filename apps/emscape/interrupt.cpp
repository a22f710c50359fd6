#include "apps/emscape/interrupt.h"

#include <csignal>

namespace emscape::app {
namespace {

StopFlag stop{false};
volatile std::sig_atomic_t caught_signal = 0;
static_assert(StopFlag::is_always_lock_free, "a signal handler may set only lock-free atomics");

void onSignal(int signal) {
  caught_signal = signal;
  stop = true;
}

}  // namespace

void catchInterrupts() {
  struct sigaction action {};
  action.sa_handler = onSignal;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

const StopFlag& stopFlag() {
  return stop;
}

void stopIfInterrupted() {
  if (stop) throw Interrupted{caught_signal};
}

}  // namespace emscape::app
