#include "playback/frames/prefetching_source.h"

#include <algorithm>

#include "playback/frames/frame_cache.h"

namespace emscape::playback {

PrefetchingSource::PrefetchingSource(FrameSource& source, const PrefetchOptions& options, Clock& clock,
                                     std::function<void(int)> ready)
    : source_(source),
      options_(options),
      clock_(clock),
      ready_(std::move(ready)),
      cache_(std::make_unique<FrameCache>(options.cache_bytes)),
      thread_([this] { run(); }) {}

PrefetchingSource::~PrefetchingSource() {
  {
    std::lock_guard<std::mutex> lock(mutex_);
    closing_ = true;
  }
  wake_.set();
  thread_.join();
}

void PrefetchingSource::request(int index) {
  {
    std::lock_guard<std::mutex> lock(mutex_);
    rethrowFailure();
    requested_ = std::clamp(index, 0, source_.count() - 1);
    if (const Frame* frame = cache_->find(requested_)) latest_ = IndexedFrame{requested_, *frame};
  }
  wake_.set();
}

int PrefetchingSource::requestTime(double time_s) {
  const int index = source_.nearestIndex(time_s);
  request(index);
  return index;
}

int PrefetchingSource::requested() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return requested_;
}

std::optional<IndexedFrame> PrefetchingSource::latest() const {
  std::lock_guard<std::mutex> lock(mutex_);
  rethrowFailure();
  return latest_;
}

Frame PrefetchingSource::wait(int index) {
  request(index);
  std::unique_lock<std::mutex> lock(mutex_);
  stored_.wait(lock, [&] { return failure_ || (latest_ && latest_->index == index) || requested_ != index; });
  rethrowFailure();
  if (latest_ && latest_->index == index) return latest_->frame;
  throw Error(ErrorCode::other, "another frame was requested while this one was waited for");
}

std::vector<int> PrefetchingSource::cached() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return cache_->indices();
}

long long PrefetchingSource::computed() const {
  std::lock_guard<std::mutex> lock(mutex_);
  return computed_;
}

void PrefetchingSource::run() {
  constexpr double kNever_ms = -1e300;
  double seek_begun_ms = kNever_ms;
  int computed_before = -1;
  for (;;) {
    std::unique_lock<std::mutex> lock(mutex_);
    if (closing_) return;
    const int index = nextIndex();
    if (index < 0) {
      lock.unlock();
      wake_.wait();
      continue;
    }
    const bool is_seek = index == requested_ && index != computed_before + 1;
    const double may_begin_ms = seek_begun_ms + options_.min_seek_interval_ms;
    lock.unlock();
    const double now_ms = clock_.now_ms();
    if (is_seek && now_ms < may_begin_ms) {
      clock_.waitUntil(may_begin_ms, wake_);
      continue;
    }
    if (is_seek) seek_begun_ms = now_ms;
    int done = index;
    try {
      keep(index, source_.frame(index));
      computed_before = index;
    } catch (...) {
      lock.lock();
      failure_ = std::current_exception();
      requested_ = -1;
      lock.unlock();
      done = -1;
    }
    stored_.notify_all();
    if (ready_) ready_(done);
  }
}

int PrefetchingSource::nextIndex() const {
  if (requested_ < 0) return -1;
  if (!cache_->find(requested_)) return requested_;
  const int last = std::min(requested_ + options_.steps_ahead, source_.count() - 1);
  for (int index = requested_ + 1; index <= last; ++index) {
    if (cache_->find(index)) continue;
    return cache_->wouldKeep(index, [this](int other) { return distance(other); }) ? index : -1;
  }
  return -1;
}

long long PrefetchingSource::distance(int index) const {
  const long long steps = static_cast<long long>(index) - requested_;
  return steps >= 0 ? steps : options_.steps_ahead - steps;
}

void PrefetchingSource::keep(int index, Frame frame) {
  std::lock_guard<std::mutex> lock(mutex_);
  ++computed_;
  frame.changed = true;  // the previously requested frame may be any
  // A recently requested frame is newer than the shown one, even if another one is requested now.
  if (index == requested_ || !latest_ || latest_->index != requested_) latest_ = IndexedFrame{index, frame};
  cache_->keep(index, std::move(frame), [this](int other) { return distance(other); });
}

void PrefetchingSource::rethrowFailure() const {
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace emscape::playback
