#include "apps/view/session/background_jobs.h"

#include <exception>
#include <utility>

namespace emscape::view {

BackgroundJobs::BackgroundJobs(std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this] { work(); }) {}

BackgroundJobs::~BackgroundJobs() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void BackgroundJobs::run(Job job) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_.push_back(std::move(job));
  }
  changed_.notify_one();
}

bool BackgroundJobs::busy() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return running_ || !waiting_.empty() || !done_.empty();
}

bool BackgroundJobs::finish() {
  Finish finish;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (done_.empty()) return false;
    finish = std::move(done_.front());
    done_.pop_front();
  }
  if (finish) finish();
  return true;
}

void BackgroundJobs::work() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return closing_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    const Job job = std::move(waiting_.front());
    waiting_.pop_front();
    running_ = true;
    lock.unlock();
    Finish finish;
    try {
      finish = job();
    } catch (...) {
      finish = [failure = std::current_exception()] { std::rethrow_exception(failure); };
    }
    lock.lock();
    done_.push_back(std::move(finish));
    running_ = false;
    lock.unlock();
    wake_();
    lock.lock();
  }
}

}  // namespace emscape::view
