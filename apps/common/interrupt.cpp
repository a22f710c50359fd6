#include "apps/common/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <ctime>

namespace emscape::app {
namespace {

constexpr int kStops[] = {SIGINT, SIGTERM, SIGHUP, SIGXCPU};

StopFlag stop{false};
/// After a signal, for what no stop flag ends: a library that waits. Also on a loaded machine much more than
/// the program's own loops and its last writes need.
constexpr unsigned kPatience_s = 20;
volatile std::sig_atomic_t signal_caught = 0;
volatile std::sig_atomic_t ends_at_once = 0;
volatile std::sig_atomic_t ignores_further = 0;
timespec first_caught{};
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

/// True within a second of the first signal, which may come twice: `timeout` and schedulers send it to the
/// process and to its group.
bool isSameStop() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec - first_caught.tv_sec < (now.tv_nsec < first_caught.tv_nsec ? 2 : 1);
}

void onSignal(int signal) {
  if (ends_at_once != 0) endAtOnce(signal);
  if (signal_caught == 0) {
    clock_gettime(CLOCK_MONOTONIC, &first_caught);
    signal_caught = signal;
    stop = true;
    alarm(kPatience_s);
  } else if (ignores_further == 0 && signal != SIGXCPU && !isSameStop()) {
    std::signal(signal, SIG_DFL);
    raise(signal);
  }
}

void onAlarm(int) {
  if (signal_caught != 0) endAtOnce(signal_caught);
}

void catchSignal(int signal) {
  struct sigaction before {};
  // Signals that are ignored at the start (nohup, background jobs) stay ignored.
  if (sigaction(signal, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) return;
  struct sigaction action {};
  action.sa_handler = onSignal;
  action.sa_flags = SA_RESTART;
  for (const int other : kStops) sigaddset(&action.sa_mask, other);
  sigaction(signal, &action, nullptr);
}

}  // namespace

void handleSignals() {
  for (const int signal : {SIGPIPE, SIGXFSZ}) std::signal(signal, SIG_IGN);
  std::signal(SIGALRM, onAlarm);
  for (const int signal : kStops) catchSignal(signal);
}

void ignoreFurtherSignals() {
  ignores_further = 1;
}

EndAtInterrupts::EndAtInterrupts() {
  ends_at_once = 1;
}

EndAtInterrupts::~EndAtInterrupts() {
  ends_at_once = 0;
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
