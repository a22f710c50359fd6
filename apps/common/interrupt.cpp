#include "apps/common/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace emscape::app {
namespace {

StopFlag stop{false};
volatile std::sig_atomic_t signal_caught = 0;
volatile std::sig_atomic_t ends_at_once = 0;
static_assert(StopFlag::is_always_lock_free, "a signal handler may set only lock-free atomics");

/// Ends the process; calls only functions that a signal handler may call.
[[noreturn]] void endAtOnce(int signal) {
  constexpr char kText[] = "emscape: stopped by signal ";
  const char number[] = {static_cast<char>('0' + signal / 10), static_cast<char>('0' + signal % 10), '\n'};
  const std::size_t zeros = signal < 10 ? 1 : 0;
  if (write(STDERR_FILENO, kText, sizeof kText - 1) > 0) {
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, number + zeros, sizeof number - zeros);
  }
  _exit(128 + signal);
}

void onSignal(int signal) {
  if (ends_at_once != 0) endAtOnce(signal);
  signal_caught = signal;
  stop = true;
}

void catchSignal(int signal) {
  struct sigaction before {};
  // Signals that are ignored at the start (nohup, background jobs) stay ignored.
  if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = onSignal;
  action.sa_flags = SA_RESTART;
  // SIGXCPU is repeated each second; the limit's maximum ends the program.
  if (signal != SIGXCPU) action.sa_flags |= static_cast<int>(SA_RESETHAND);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void handleSignals() {
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGXCPU}) catchSignal(signal);
}

void endAtInterrupts() {
  ends_at_once = 1;
}

const StopFlag& stopFlag() {
  return stop;
}

int caughtSignal() {
  return signal_caught;
}

void stopIfInterrupted() {
  throwIfStopped(&stop);
}

}  // namespace emscape::app
