/// Background jobs, such as file access, of the window's thread.
#pragma once

#include <functional>
#include <utility>

#include "base/worker.h"

namespace emscape::view {

/// Runs jobs one after another on its own thread. The owner's thread handles their results in finish(). The
/// destructor waits for all jobs, so that a file being saved is completed; handlers are not called.
class BackgroundJobs {
 public:
  /// Handles the result; called on the owner's thread.
  using Finish = std::function<void()>;

  /// @param wake  called on the thread of the jobs after each
  explicit BackgroundJobs(std::function<void()> wake) : jobs_(std::move(wake)) {}

  /// Does not wait. @param job  its exceptions are rethrown by finish()
  void run(std::function<Finish()> job) { jobs_.start(std::move(job)); }
  /// True if a job is waiting, running, or not yet finished by finish().
  bool busy() const { return jobs_.active(); }
  /// Finishes the oldest completed job. @return true if there was one
  bool finish() {
    if (!jobs_.done()) return false;
    if (const Finish finish = jobs_.take()) finish();
    return true;
  }

 private:
  AsyncTasks<Finish> jobs_;
};

}  // namespace emscape::view
