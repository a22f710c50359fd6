/// Background jobs, in order, on one thread.
#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace emscape::playback {

/// Runs jobs one after another. After a job has thrown, later ones are dropped and the exception reaches the
/// caller at its next push() or finish().
class BackgroundWriter {
 public:
  /// @param max_waiting  push() waits while this number of jobs are waiting, which limits their memory
  explicit BackgroundWriter(std::size_t max_waiting);
  /// Finishes the running job and drops the waiting ones.
  ~BackgroundWriter();
  BackgroundWriter(const BackgroundWriter&) = delete;
  BackgroundWriter& operator=(const BackgroundWriter&) = delete;

  void push(std::function<void()> job);
  /// Waits until every job is done.
  void finish();

 private:
  void run();

  const std::size_t max_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool busy_ = false;
  bool closing_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace emscape::playback
