/// One task at a time on a thread, and an event that is signalled on completion.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace emscape::playback {

/// An auto-reset event: one thread waits, any thread may set it.
class Event {
 public:
  void set() {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      set_ = true;
    }
    changed_.notify_one();
  }
  /// Waits until it is set; returns at once if it was set since the last wait.
  void wait() {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return set_; });
    set_ = false;
  }
  /// The same, at most until `time`.
  void waitUntil(std::chrono::steady_clock::time_point time) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait_until(lock, time, [this] { return set_; });
    set_ = false;
  }

  /// Reports the beginning of work that ends with finish(), so that a simulated clock knows whether work is
  /// in progress.
  void begin() { ++begun_; }
  /// set(), at the end of work.
  void finish() {
    --begun_;
    set();
  }
  bool hasWork() const { return begun_ > 0; }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool set_ = false;
  std::atomic<int> begun_{0};
};

/// The owner starts a task, polls it, and takes the result. One thread owns it. All tasks run on the same
/// thread, because oneTBB keeps memory until the program ends for each thread that enters a loop.
template <class Result>
class AsyncTask {
 public:
  /// @param event  set at the end of the work; outlives this
  explicit AsyncTask(Event& event) : event_(event) {}
  /// Waits for the end of the work.
  ~AsyncTask() {
    if (!thread_.joinable()) return;
    if (active_) end_.wait();
    begin_.set();  // without work
    thread_.join();
  }
  AsyncTask(const AsyncTask&) = delete;
  AsyncTask& operator=(const AsyncTask&) = delete;

  /// Starts a task. The previous result must have been taken.
  void start(std::function<Result()> work) {
    active_ = true;
    done_ = false;
    work_ = std::move(work);
    event_.begin();
    if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
    begin_.set();
  }
  /// True if the task runs or its result has not been taken.
  bool active() const { return active_; }
  bool done() const { return active_ && done_; }
  /// Waits for the end. Rethrows an exception of the work.
  Result take() {
    end_.wait();
    active_ = false;
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
    Result result = std::move(*result_);
    result_.reset();
    return result;
  }

 private:
  void run() {
    for (begin_.wait(); work_; begin_.wait()) {
      try {
        result_ = work_();
      } catch (...) {
        failure_ = std::current_exception();
      }
      work_ = nullptr;
      done_ = true;
      event_.finish();
      end_.set();
    }
  }

  Event& event_;
  Event begin_, end_;  // of the work
  bool active_ = false;
  std::atomic<bool> done_{false};
  std::function<Result()> work_;
  std::optional<Result> result_;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace emscape::playback
