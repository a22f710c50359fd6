/// A share of the processor for the loops of one thread.
#pragma once

#include <functional>
#include <memory>

namespace emscape {

/// Bounds the threads that loops (parallelFor) of one piece of work use, where several threads of a program
/// have loops at the same time: without it each of them spreads over every core.
///
/// One arena belongs to one working thread. Arenas are not shared between them: in a full arena a thread
/// waits until another one leaves it, so that a picture would wait for a field.
class ThreadArena {
 public:
  /// @param threads  >= 1, the calling thread included; less counts as 1. More than the machine or
  /// setThreadLimit() allow has no effect
  /// @param niceness 0..19: nice value, as of nice(1), that threads get when they enter, for good: background
  /// work then yields to a window. Linux only; no effect elsewhere
  explicit ThreadArena(int threads, int niceness = 0);
  ~ThreadArena();
  ThreadArena(const ThreadArena&) = delete;
  ThreadArena& operator=(const ThreadArena&) = delete;

  /// Calls the body in the calling thread; its loops use the threads of this arena. Its exception reaches the
  /// caller.
  void run(const std::function<void()>& body);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape
