/// A share of the processor for the loops of one thread.
#pragma once

#include <functional>
#include <memory>

namespace emscape {

/// Limits the threads that loops (parallelFor) of one task use, if several threads of a program run loops at
/// the same time. Without it each of them uses all cores.
///
/// Each working thread has its own arena, because in a full arena a thread waits until another one leaves, so
/// that a picture would wait for a field.
class ThreadArena {
 public:
  /// @param threads  >= 1, the calling thread included; less counts as 1. More than the machine or
  /// setThreadLimit() allow has no effect
  /// @param niceness 0..19: nice value, as in nice(1), that threads permanently get when they enter, so that
  /// background work yields to a window. Linux only; no effect elsewhere
  explicit ThreadArena(int threads, int niceness = 0);
  ~ThreadArena();
  ThreadArena(const ThreadArena&) = delete;
  ThreadArena& operator=(const ThreadArena&) = delete;

  /// Calls the body in the calling thread; its loops use the threads of this arena. Exceptions are passed to
  /// the caller.
  void run(const std::function<void()>& body);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape
