#include "apps/view/playhead.h"

#include <algorithm>
#include <cmath>

namespace emscape::view {
namespace {

constexpr double kSameTime_s = 1e-9;

}  // namespace

const std::vector<double>& Playhead::rates() {
  static const std::vector<double> rates{0.1, 0.25, 0.5, 1, 2, 5, 10, 30, 60, 120};
  return rates;
}

void Playhead::setTimes_s(std::vector<double> times_s) {
  times_s_ = std::move(times_s);
  if (!times_s_.empty()) seek(time_s_);
}

int Playhead::step() const {
  const auto after = std::upper_bound(times_s_.begin(), times_s_.end(), time_s_ + kSameTime_s);
  return times_s_.empty() ? -1 : std::max(0, static_cast<int>(after - times_s_.begin()) - 1);
}

double Playhead::step_s() const {
  return times_s_.empty() ? time_s_ : times_s_[static_cast<std::size_t>(step())];
}

void Playhead::play() {
  playing_ = times_s_.size() > 1;
  if (playing_ && time_s_ >= times_s_.back()) time_s_ = times_s_.front();
}

void Playhead::changeRate(int direction) {
  const std::vector<double>& all = rates();
  if (direction > 0) {
    const auto above = std::upper_bound(all.begin(), all.end(), rate_);
    rate_ = above == all.end() ? all.back() : *above;
  } else {
    const auto at_least = std::lower_bound(all.begin(), all.end(), rate_);
    rate_ = at_least == all.begin() ? all.front() : *std::prev(at_least);
  }
}

void Playhead::seek(double time_s) {
  time_s_ = time_s;
  if (times_s_.empty()) return;
  const auto after = std::lower_bound(times_s_.begin(), times_s_.end(), time_s);
  if (after == times_s_.end()) {
    time_s_ = times_s_.back();
  } else if (after == times_s_.begin()) {
    time_s_ = times_s_.front();
  } else {
    time_s_ = time_s - *std::prev(after) <= *after - time_s ? *std::prev(after) : *after;
  }
}

void Playhead::stepBy(int steps) {
  playing_ = false;
  if (times_s_.empty()) return;
  const int last = static_cast<int>(times_s_.size()) - 1;
  time_s_ = times_s_[static_cast<std::size_t>(std::clamp(step() + steps, 0, last))];
}

void Playhead::advance(double elapsed_s) {
  if (!playing_) return;
  time_s_ += elapsed_s * rate_;
  const double begin_s = times_s_.front();
  const double end_s = times_s_.back();
  if (time_s_ < end_s) return;
  if (!loop_) {
    time_s_ = end_s;
    playing_ = false;
    return;
  }
  // The last step stays for as long as the one before it.
  const double last_step_s = end_s - times_s_[times_s_.size() - 2];
  const double period_s = end_s - begin_s + last_step_s;
  if (time_s_ >= end_s + last_step_s) time_s_ = begin_s + std::fmod(time_s_ - begin_s, period_s);
}

std::optional<double> Playhead::untilNextStep_s() const {
  if (!playing_) return std::nullopt;
  const std::size_t next = static_cast<std::size_t>(step()) + 1;
  const double due_s =
      next < times_s_.size() ? times_s_[next] : 2 * times_s_.back() - times_s_[times_s_.size() - 2];
  return std::max(0.0, due_s - time_s_) / rate_;
}

}  // namespace emscape::view
