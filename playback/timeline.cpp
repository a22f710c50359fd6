#include "emscape/playback/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/render/legend.h"

namespace emscape::playback {
namespace {

using scenario::TimeInterval;

/// Distances between ticks from a second to a day (s); beyond they are decimal.
constexpr double kTickSteps_s[] = {1,   2,   5,    10,   15,   30,    60,    120,   300,
                                   600, 900, 1800, 3600, 7200, 10800, 21600, 43200, 86400};

double tickStep_s(double span_s, int count) {
  const double wanted_s = span_s / std::max(count, 1);
  if (wanted_s > kTickSteps_s[0]) {
    for (const double step_s : kTickSteps_s) {
      if (step_s >= wanted_s) return step_s;
    }
  }
  // Below a second, and in days above a day.
  const double unit_s = wanted_s > kTickSteps_s[0] ? 86400 : 1;
  const double power = std::pow(10.0, std::floor(std::log10(wanted_s / unit_s)));
  for (const double factor : {1.0, 2.0, 5.0, 10.0}) {
    if (factor * power * unit_s >= wanted_s * (1 - 1e-9)) return factor * power * unit_s;
  }
  return 10 * power * unit_s;
}

/// The time of day of an ISO 8601 time, with as many decimals as another text of seconds has.
std::string timeOfDay(const std::string& utc, const std::string& seconds_text) {
  if (utc.empty()) return "";
  const std::size_t begin = utc.find('T') + 1, point = utc.find('.', begin);
  const std::size_t decimal_point = seconds_text.find('.');
  const std::size_t decimals = decimal_point == std::string::npos
                                   ? 0
                                   : std::min<std::size_t>(3, seconds_text.size() - decimal_point - 1);
  return utc.substr(begin, point - begin) + (decimals == 0 ? "" : utc.substr(point, 1 + decimals));
}

}  // namespace

const std::vector<double>& playRates() {
  static const std::vector<double> rates{0.1, 0.25, 0.5, 1, 2, 5, 10, 30, 60, 120};
  return rates;
}

double snappedRate(double rate) {
  const std::vector<double>& rates = playRates();
  const double size = std::abs(rate);
  const double nearest = *std::min_element(rates.begin(), rates.end(), [size](double a, double b) {
    return std::abs(std::log(a / size)) < std::abs(std::log(b / size));
  });
  return std::copysign(nearest, rate);
}

std::vector<ActivityBar> activityBarsOf(const scenario::Scenario& scenario, double from_s, double to_s) {
  std::vector<ActivityBar> bars;
  for (const scenario::Emitter& emitter : scenario.emitters) {
    ActivityBar bar{emitter.name, {}};
    if (emitter.active_s.empty()) bar.intervals.push_back({from_s, to_s});
    for (const TimeInterval& interval : emitter.active_s) {
      const TimeInterval seen{std::max(interval.begin_s, from_s), std::min(interval.end_s, to_s)};
      if (seen.begin_s < seen.end_s) bar.intervals.push_back(seen);
    }
    std::sort(bar.intervals.begin(), bar.intervals.end(),
              [](const TimeInterval& a, const TimeInterval& b) { return a.begin_s < b.begin_s; });
    std::vector<TimeInterval> merged;
    for (const TimeInterval& interval : bar.intervals) {
      if (!merged.empty() && interval.begin_s <= merged.back().end_s) {
        merged.back().end_s = std::max(merged.back().end_s, interval.end_s);
      } else {
        merged.push_back(interval);
      }
    }
    bar.intervals = std::move(merged);
    bars.push_back(std::move(bar));
  }
  return bars;
}

Timeline::Timeline(std::vector<double> times_s, std::string epoch_utc, std::vector<ActivityBar> bars)
    : times_s_(std::move(times_s)), epoch_utc_(std::move(epoch_utc)), bars_(std::move(bars)) {
  if (times_s_.empty()) throw Error(ErrorCode::other, "Timeline: no step is given");
  time_s_ = times_s_.front();
}

Timeline::Timeline(std::vector<double> times_s, const scenario::Scenario& scenario)
    : Timeline(std::move(times_s), scenario.clock.epoch_utc) {
  bars_ = activityBarsOf(scenario, begin_s(), end_s());
}

std::vector<TimelineTick> Timeline::ticks(double from_s, double to_s, int count) const {
  std::vector<TimelineTick> ticks;
  if (!(from_s < to_s) || !std::isfinite(to_s - from_s)) return ticks;
  const double step_s = tickStep_s(to_s - from_s, count);
  const scenario::Clock clock{epoch_utc_, 0, 1};
  // By whole numbers of steps, so that no error adds up.
  for (double n = std::ceil(from_s / step_s - 1e-9); n * step_s <= to_s + 1e-9 * step_s; ++n) {
    const double time_s = n * step_s;
    const std::string text = render::tickText(time_s, step_s);
    ticks.push_back({time_s, text, timeOfDay(scenario::utcAt(clock, time_s), text)});
  }
  return ticks;
}

std::vector<TimeInterval> Timeline::cachedSpans(const std::vector<int>& steps) const {
  const auto last = static_cast<int>(times_s_.size()) - 1;
  const auto time = [this](int step) { return times_s_[static_cast<std::size_t>(step)]; };
  std::vector<TimeInterval> spans;
  int before = -2;
  for (const int step : steps) {
    if (step < 0 || step > last) continue;
    const double from_s = step == 0 ? time(0) : 0.5 * (time(step - 1) + time(step));
    const double to_s = step == last ? time(last) : 0.5 * (time(step) + time(step + 1));
    if (step == before + 1) {
      spans.back().end_s = to_s;
    } else {
      spans.push_back({from_s, to_s});
    }
    before = step;
  }
  return spans;
}

void Timeline::seek(double time_s) {
  if (!std::isnan(time_s)) time_s_ = std::clamp(time_s, begin_s(), end_s());
}

int Timeline::nearestStep(double time_s) const {
  const auto after = std::lower_bound(times_s_.begin(), times_s_.end(), time_s);
  if (after == times_s_.begin()) return 0;
  const auto index = static_cast<int>(after - times_s_.begin());
  if (after == times_s_.end()) return index - 1;
  return *after - time_s < time_s - *(after - 1) ? index : index - 1;
}

void Timeline::goToStep(int step) {
  playing_ = false;
  const auto last = static_cast<int>(times_s_.size()) - 1;
  time_s_ = times_s_[static_cast<std::size_t>(std::clamp(step, 0, last))];
}

void Timeline::stepBy(int steps) {
  const auto last = static_cast<int>(times_s_.size()) - 1;
  goToStep(step() + std::clamp(steps, -last, last));
}

void Timeline::play() {
  playing_ = begin_s() < end_s();
  if (rate_ > 0 && time_s_ >= end_s()) time_s_ = begin_s();
  if (rate_ < 0 && time_s_ <= begin_s()) time_s_ = end_s();
}

void Timeline::setRate(double rate) {
  if (rate != 0 && std::isfinite(rate)) rate_ = rate;
}

void Timeline::faster() {
  const std::vector<double>& rates = playRates();
  const auto next = std::upper_bound(rates.begin(), rates.end(), std::abs(rate_));
  if (next != rates.end()) rate_ = std::copysign(*next, rate_);
}

void Timeline::slower() {
  const std::vector<double>& rates = playRates();
  const auto next = std::lower_bound(rates.begin(), rates.end(), std::abs(rate_));
  if (next != rates.begin()) rate_ = std::copysign(*(next - 1), rate_);
}

double Timeline::advance(double dt_s) {
  if (!playing_ || !(dt_s > 0)) return time_s_;
  const double span_s = end_s() - begin_s();
  const double next_s = time_s_ + rate_ * dt_s;
  if (next_s >= begin_s() && next_s <= end_s()) {
    time_s_ = next_s;
  } else if (loop_) {
    const double beyond_s = std::fmod(next_s - begin_s(), span_s);
    time_s_ = begin_s() + (beyond_s < 0 ? beyond_s + span_s : beyond_s);
  } else {
    time_s_ = next_s > end_s() ? end_s() : begin_s();
    playing_ = false;
  }
  return time_s_;
}

}  // namespace emscape::playback
