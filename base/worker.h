/// Background work on one thread: jobs, and tasks with results.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <future>
#include <limits>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

namespace emscape {

/// Runs jobs one after another on its own thread, which starts with the first job. All jobs run on the same
/// thread, because oneTBB keeps memory until the program ends for each thread that enters a loop. After a job
/// has thrown, later ones are dropped and the exception reaches the caller at its next push() or finish().
class Worker {
 public:
  /// @param max_waiting  push() waits while this number of jobs are waiting, which limits their memory
  explicit Worker(std::size_t max_waiting = std::numeric_limits<std::size_t>::max())
      : max_waiting_(max_waiting) {}
  /// Finishes the running job and drops the waiting ones.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

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

/// Tasks that run one after another on a worker. The owner starts them, polls, and takes the results in the
/// order of the starts. One thread owns it.
template <class Result>
class AsyncTasks {
 public:
  /// @param wake  called on the thread of the tasks when a result is ready; may be empty
  explicit AsyncTasks(std::function<void()> wake = {}) : wake_(std::move(wake)) {}
  /// Waits for the end of all tasks.
  ~AsyncTasks() { worker_.finish(); }
  AsyncTasks(const AsyncTasks&) = delete;
  AsyncTasks& operator=(const AsyncTasks&) = delete;

  void start(std::function<Result()> work) {
    const auto task = std::make_shared<std::packaged_task<Result()>>(std::move(work));
    results_.push_back(task->get_future());
    worker_.push([this, task] {
      (*task)();
      if (wake_) wake_();
    });
  }
  /// True if a result has not been taken.
  bool active() const { return !results_.empty(); }
  /// True if take() does not wait.
  bool done() const {
    return active() && results_.front().wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }
  /// The oldest result; waits for it. Rethrows an exception of the task.
  Result take() {
    std::future<Result> result = std::move(results_.front());
    results_.pop_front();
    return result.get();
  }

 private:
  const std::function<void()> wake_;
  std::deque<std::future<Result>> results_;
  Worker worker_;
};

}  // namespace emscape
