/// Files and counts beside the thread of the window, which never waits for them.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace emscape::view {

/// Runs jobs one after another on a thread of its own. What is to come of a job is done by the thread that
/// owns this object.
class BackgroundJobs {
 public:
  /// What the owner's thread does with the result.
  using Finish = std::function<void()>;
  using Job = std::function<Finish()>;

  /// @param wake  called on the thread of the jobs after each
  explicit BackgroundJobs(std::function<void()> wake);
  /// Waits for the end of all jobs: a file that is being saved is saved. Nothing is finished any more.
  ~BackgroundJobs();
  BackgroundJobs(const BackgroundJobs&) = delete;
  BackgroundJobs& operator=(const BackgroundJobs&) = delete;

  /// Does not wait. @param job  what it throws is thrown by finish()
  void run(Job job);
  /// Whether a job waits, runs, or is not finished.
  bool busy() const;
  /// Finishes the oldest job that is done. @return whether there was one
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
