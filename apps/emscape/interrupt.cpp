#include "apps/emscape/interrupt.h"

#include <csignal>

namespace emscape::app {
namespace {

StopFlag stop{false};
volatile std::sig_atomic_t signal_caught = 0;
static_assert(StopFlag::is_always_lock_free, "a signal handler may set only lock-free atomics");

void onSignal(int signal) {
  signal_caught = signal;
  stop = true;
}

void catchSignal(int signal) {
  struct sigaction before {};
  // Signals that are ignored at the start (nohup, background jobs) stay ignored.
  if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = onSignal;
  action.sa_flags = SA_RESTART | static_cast<int>(SA_RESETHAND);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void catchInterrupts() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) catchSignal(signal);
}

const StopFlag& stopFlag() {
  return stop;
}

int caughtSignal() {
  return signal_caught;
}

void stopIfInterrupted() {
  playback::throwIfStopped(&stop);
}

}  // namespace emscape::app
