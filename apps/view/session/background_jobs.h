/// Background jobs, such as file access, of the window's thread.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace emscape::view {

/// Runs jobs one after another on its own thread. The owner's thread handles their results in finish().
class BackgroundJobs {
 public:
  /// Handles the result; called on the owner's thread.
  using Finish = std::function<void()>;
  using Job = std::function<Finish()>;

  /// @param wake  called on the thread of the jobs after each
  explicit BackgroundJobs(std::function<void()> wake);
  /// Waits for all jobs, so that a file being saved is completed. Handlers are not called.
  ~BackgroundJobs();
  BackgroundJobs(const BackgroundJobs&) = delete;
  BackgroundJobs& operator=(const BackgroundJobs&) = delete;

  /// Does not wait. @param job  its exceptions are rethrown by finish()
  void run(Job job);
  /// True if a job is waiting, running, or not yet finished by finish().
  bool busy() const;
  /// Finishes the oldest completed job. @return true if there was one
  bool finish();

 private:
  void work();

  const std::function<void()> wake_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> waiting_;
  std::deque<Finish> done_;
  bool running_ = false;
  bool closing_ = false;
  std::thread thread_;
};

}  // namespace emscape::view
