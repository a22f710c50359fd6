#include "emscape/base/work.h"

#include <algorithm>
#include <utility>

namespace emscape {
namespace {

thread_local Work* current_work = nullptr;

}  // namespace

void Work::begin(const std::string& what) {
  const std::lock_guard<std::mutex> lock(mutex_);
  stop_at_ = Time::max().time_since_epoch().count();
  begin_ = 0;
  end_ = 1;
  done_ = -1;
  what_ = what;
  part_.clear();
}

void Work::stopAt(Time time) {
  const Time::rep wanted = time.time_since_epoch().count();
  for (Time::rep now = stop_at_; wanted < now && !stop_at_.compare_exchange_weak(now, wanted);) {
  }
}

bool Work::isStopped() const {
  if (flag_ != nullptr && *flag_) return true;
  const Time::rep at = stop_at_.load(std::memory_order_relaxed);
  if (at == Time::max().time_since_epoch().count()) return false;
  return std::chrono::steady_clock::now().time_since_epoch().count() >= at;
}

WorkProgress Work::progress() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return {what_, part_, done_};
}

WorkScope::WorkScope(Work* work) : before_(std::exchange(current_work, work)) {}

WorkScope::~WorkScope() {
  current_work = before_;
}

Work* currentWork() {
  return current_work;
}

void checkpoint() {
  if (current_work != nullptr && current_work->isStopped()) throw Stopped();
}

WorkPart::WorkPart(const std::string& name, double from, double to) : work_(current_work) {
  checkpoint();
  if (work_ == nullptr) return;
  begin_ = work_->begin_;
  end_ = work_->end_;
  work_->begin_ = begin_ + from * (end_ - begin_);
  work_->end_ = begin_ + to * (end_ - begin_);
  const std::lock_guard<std::mutex> lock(work_->mutex_);
  name_ = work_->part_;
  if (!name.empty()) work_->part_ = name;
}

WorkPart::~WorkPart() {
  if (work_ == nullptr) return;
  if (!std::uncaught_exceptions()) reportDone(1);
  work_->begin_ = begin_;
  work_->end_ = end_;
  const std::lock_guard<std::mutex> lock(work_->mutex_);
  work_->part_ = std::move(name_);
}

void reportDone(double fraction) {
  Work* const work = current_work;
  if (work == nullptr) return;
  const double begin = work->begin_, end = work->end_;
  const double done = begin + std::clamp(fraction, 0.0, 1.0) * (end - begin);
  for (double before = work->done_; done > before && !work->done_.compare_exchange_weak(before, done);) {
  }
}

}  // namespace emscape
