/// Background work that serves only the latest request.
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "playback/live/mailbox.h"

namespace emscape::playback {

/// Runs one task after another on its own thread. A new request replaces a pending one, and a new result
/// replaces one that was not taken. One thread requests and takes results; only the destructor waits, for the
/// end of the running task.
template <class Request, class Result>
class LatestWorker {
 public:
  using Work = std::function<Result(const Request&)>;

  /// @param work  must not throw; on the thread of this object
  /// @param wake  called on the same thread when there is a result; may be empty
  LatestWorker(Work work, std::function<void()> wake)
      : work_(std::move(work)), wake_(std::move(wake)), thread_([this] { run(); }) {}
  ~LatestWorker() {
    closing_ = true;
    event_.set();
    thread_.join();
  }
  LatestWorker(const LatestWorker&) = delete;
  LatestWorker& operator=(const LatestWorker&) = delete;

  void ask(Request request) { inbox_.put({++asked_, std::move(request)}); }
  /// The latest result, once.
  std::optional<Result> take() {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (result_) taken_ = done_;
    return std::exchange(result_, std::nullopt);
  }
  /// True if the result of the last request is pending or not taken.
  bool isBusy() const { return taken_ != asked_; }

 private:
  struct Numbered {
    long long number;
    Request request;
  };

  void run() {
    while (!closing_) {
      const auto letter = inbox_.take();
      if (!letter) {
        event_.wait();
        continue;
      }
      Result result = work_(letter->value.request);
      {
        const std::lock_guard<std::mutex> lock(mutex_);
        result_ = std::move(result);
        done_ = letter->value.number;
      }
      if (wake_) wake_();
    }
  }

  const Work work_;
  const std::function<void()> wake_;
  Event event_;
  Mailbox<Numbered> inbox_{event_};
  std::atomic<bool> closing_{false};
  long long asked_ = 0, taken_ = 0;  // numbers of requests; of the asking thread
  std::mutex mutex_;
  long long done_ = 0;  // number of the request of the result
  std::optional<Result> result_;
  std::thread thread_;
};

}  // namespace emscape::playback
