#include "playback/editing/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/text/time_text.h"
#include "emscape/render/annotate/legend.h"
#include "scenario/model/typed_time.h"

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

constexpr double kMinute_s = 60, kHour_s = 3600, kDay_s = 86400;

/// The text of a tick.
std::string textOfTick(double time_s, double step_s, double span_s) {
  if (span_s < kHour_s || step_s < 1) return render::tickText(time_s, step_s) + " s";
  const std::string text = timeText(time_s, span_s);
  if (step_s >= kDay_s) return text.substr(0, text.find(' ')) + " d";
  return step_s >= kMinute_s ? text.substr(0, text.size() - 3) : text;  // without ":00"
}

/// Decimals of a number's text.
std::size_t decimalsOf(const std::string& number) {
  const std::size_t point = number.find('.');
  if (point == std::string::npos) return 0;
  return std::min<std::size_t>(3, number.size() - point - 1);
}

/// "2026-06-02" of an ISO 8601 time; empty for an empty one.
std::string dateOf(const std::string& utc) {
  return utc.substr(0, utc.find('T'));
}

/// The time of day of an ISO 8601 time.
std::string timeOfDay(const std::string& utc, std::size_t decimals) {
  if (utc.empty()) return "";
  const std::size_t begin = utc.find('T') + 1, point = utc.find('.', begin);
  return utc.substr(begin, point - begin) + (decimals == 0 ? "" : utc.substr(point, 1 + decimals));
}

/// Of the steps' span.
constexpr double kMinVisible = 1e-6;

}  // namespace

const std::vector<double>& playRates() {
  static const std::vector<double> rates{0.1, 0.25, 0.5, 1, 2, 5, 10, 30, 60, 120, 300, 600, 1000};
  return rates;
}

std::vector<ActivityBar> activityBarsOf(const scenario::Scenario& scenario, double from_s, double to_s) {
  std::vector<ActivityBar> bars;
  for (const scenario::Emitter& emitter : scenario.emitters) {
    ActivityBar bar{emitter.name, {}};
    if (emitter.isAlwaysActive()) bar.intervals.push_back({from_s, to_s});
    for (const TimeInterval& interval : emitter.active_s) {
      if (!emitter.enabled) break;
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
    : times_s_(std::move(times_s)),
      epoch_utc_(std::move(epoch_utc)),
      bars_(std::move(bars)),
      time_s_(begin_s()) {}

Timeline::Timeline(std::vector<double> times_s, const scenario::Scenario& scenario)
    : Timeline(std::move(times_s)) {
  setScenario(scenario);
}

void Timeline::setSteps(std::vector<double> times_s) {
  times_s_ = std::move(times_s);
  playing_ = playing_ && hasSpan();
  if (times_s_.empty()) return;
  seek(time_s_);
  if (const auto range = std::exchange(play_range_, std::nullopt)) {
    setPlayRange(range->begin_s, range->end_s);
  }
  if (const auto visible = std::exchange(visible_, std::nullopt)) {
    setVisible(visible->begin_s, visible->end_s);
  }
}

void Timeline::setScenario(const scenario::Scenario& scenario) {
  epoch_utc_ = scenario.clock.epoch_utc;
  bars_ = activityBarsOf(scenario, begin_s(), end_s());
}

std::vector<TimelineTick> Timeline::ticks(double from_s, double to_s, int count) const {
  std::vector<TimelineTick> ticks;
  if (!(from_s < to_s) || !std::isfinite(to_s - from_s)) return ticks;
  const double step_s = tickStep_s(to_s - from_s, count);
  const scenario::Clock clock{epoch_utc_, 0, 1};
  const double span_s = std::max({std::abs(begin_s()), std::abs(end_s()), to_s - from_s});
  const bool has_dates = dateOf(scenario::utcAt(clock, from_s)) != dateOf(scenario::utcAt(clock, to_s));
  std::string date;
  // By whole numbers of steps, so that no error accumulates.
  for (double n = std::ceil(from_s / step_s - 1e-9); n * step_s <= to_s + 1e-9 * step_s; ++n) {
    const double time_s = n * step_s + 0.0;  // not -0
    const std::string utc = scenario::utcAt(clock, time_s);
    std::string utc_text = timeOfDay(utc, decimalsOf(render::tickText(time_s, step_s)));
    const bool is_other_date = has_dates && std::exchange(date, dateOf(utc)) != dateOf(utc);
    if (step_s >= kDay_s) {
      utc_text = dateOf(utc);
    } else if (is_other_date && !utc.empty()) {
      utc_text = dateOf(utc).substr(5) + " " + utc_text;
    }
    ticks.push_back({time_s, textOfTick(time_s, step_s, span_s), std::move(utc_text)});
  }
  return ticks;
}

double Timeline::parseTime_s(const std::string& text) const {
  constexpr double kAny_s = std::numeric_limits<double>::infinity();
  return scenario::parseTime_s(text, {epoch_utc_, 0, 1},
                               times_s_.empty() ? TimeInterval{-kAny_s, kAny_s} : span());
}

void Timeline::requireTime(double time_s) const {
  static_cast<void>(parseTime_s(fmt::format("{}", time_s)));
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

TimeInterval Timeline::visible() const {
  return visible_.value_or(span());
}

void Timeline::setVisible(double from_s, double to_s) {
  if (!(from_s < to_s) || !hasSpan()) return;
  const double span_s = end_s() - begin_s();
  const double length_s = std::clamp(to_s - from_s, kMinVisible * span_s, span_s);
  const double begin = std::clamp(from_s, begin_s(), end_s() - length_s);
  visible_ = TimeInterval{begin, begin + length_s};
  if (length_s >= span_s) visible_.reset();
}

void Timeline::zoom(double factor, double about_s) {
  const TimeInterval seen = visible();
  setVisible(about_s - factor * (about_s - seen.begin_s), about_s + factor * (seen.end_s - about_s));
}

void Timeline::pan(double by_s) {
  const TimeInterval seen = visible();
  setVisible(seen.begin_s + by_s, seen.end_s + by_s);
}

void Timeline::follow(double before_s) {
  const TimeInterval seen = visible();
  const auto isSeen = [&](double time_s) { return time_s >= seen.begin_s && time_s <= seen.end_s; };
  if (!isSeen(before_s) || isSeen(time_s_)) return;
  const double length_s = seen.end_s - seen.begin_s;
  const double from_s = rate_ > 0 ? time_s_ : time_s_ - length_s;
  setVisible(from_s, from_s + length_s);
}

void Timeline::seek(double time_s) {
  if (std::isnan(time_s)) return;
  time_s_ = times_s_.empty() ? time_s : std::clamp(time_s, begin_s(), end_s());
  rounding_s_ = 0;
}

double Timeline::asked_s() const {
  if (!is_continuous_) return step_s();
  if (rounding_s_ == 0 || times_s_.empty()) return time_s_;
  const double per_s = std::round(1 / rounding_s_);
  const double rounded_s =
      per_s >= 1 ? std::round(time_s_ * per_s) / per_s : std::round(time_s_ / rounding_s_) * rounding_s_;
  return std::clamp(rounded_s, begin_s(), end_s());
}

void Timeline::pause() {
  if (!playing_) return;
  playing_ = false;
  if (is_continuous_) seek(asked_s());
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
  if (times_s_.empty()) return;
  const auto last = static_cast<int>(times_s_.size()) - 1;
  time_s_ = times_s_[static_cast<std::size_t>(std::clamp(step, 0, last))];
  rounding_s_ = 0;
}

void Timeline::stepBy(int steps) {
  const auto count = static_cast<int>(times_s_.size());
  int from = step();
  if (is_continuous_ && count > 0) {  // between two steps the first one ends at the next
    if (steps > 0 && step_s() > asked_s()) --from;
    if (steps < 0 && step_s() < asked_s()) ++from;
  }
  goToStep(from + std::clamp(steps, -count, count));
}

TimeInterval Timeline::playRange() const {
  return play_range_.value_or(span());
}

void Timeline::setPlayRange(double begin_s, double end_s) {
  if (std::isnan(begin_s) || std::isnan(end_s) || !hasSpan()) return;
  const auto last = static_cast<int>(times_s_.size()) - 1;
  const int first_step = std::min(nearestStep(std::min(begin_s, end_s)), last - 1);
  setPlaySteps(first_step, std::max(nearestStep(std::max(begin_s, end_s)), first_step + 1));
}

void Timeline::setPlayBegin(double time_s) {
  if (std::isnan(time_s) || !hasSpan()) return;
  const int last = nearestStep(playRange().end_s);
  setPlaySteps(std::min(nearestStep(time_s), last - 1), last);
}

void Timeline::setPlayEnd(double time_s) {
  if (std::isnan(time_s) || !hasSpan()) return;
  const int first = nearestStep(playRange().begin_s);
  setPlaySteps(first, std::max(nearestStep(time_s), first + 1));
}

void Timeline::setPlaySteps(int first, int last) {
  play_range_ =
      TimeInterval{times_s_[static_cast<std::size_t>(first)], times_s_[static_cast<std::size_t>(last)]};
  if (play_range_->begin_s == begin_s() && play_range_->end_s == end_s()) play_range_.reset();
}

void Timeline::play() {
  playing_ = hasSpan();
  const TimeInterval range = playRange();
  const bool is_before = time_s_ < range.begin_s;
  const bool is_after = time_s_ > range.end_s;
  if (rate_ > 0 && (is_before || time_s_ >= range.end_s)) time_s_ = range.begin_s;
  if (rate_ < 0 && (is_after || time_s_ <= range.begin_s)) time_s_ = range.end_s;
}

void Timeline::setRate(double rate) {
  if (rate != 0 && std::isfinite(rate)) rate_ = rate;
}

double Timeline::stepsPerSecond(double rate) const {
  if (!hasSpan()) return 0;
  return rate * static_cast<double>(times_s_.size() - 1) / (end_s() - begin_s());
}

bool Timeline::hasLongSteps() const {
  constexpr double kLong_s = 2;
  return hasSpan() && stepsPerSecond(kLong_s) <= 1;
}

std::vector<double> Timeline::usualRates() const {
  constexpr double kMaxRate = 10000, kMaxStepsPerSecond = 10;
  std::vector<double> rates = playRates();
  for (const double rate : {2000.0, 5000.0, kMaxRate}) {
    if (hasSpan() && stepsPerSecond(rate) <= kMaxStepsPerSecond) rates.push_back(rate);
  }
  return rates;
}

void Timeline::changeRate(int direction) {
  std::vector<double> rates = usualRates();
  for (const double rate : usualRates()) rates.push_back(-rate);
  std::sort(rates.begin(), rates.end());
  if (direction > 0) {
    const auto next = std::upper_bound(rates.begin(), rates.end(), rate_);
    if (next != rates.end()) rate_ = *next;
  } else {
    const auto next = std::lower_bound(rates.begin(), rates.end(), rate_);
    if (next != rates.begin()) rate_ = *(next - 1);
  }
}

double Timeline::advance(double dt_s) {
  if (!playing_ || !(dt_s > 0)) return time_s_;
  constexpr double kShown_s = 1.0 / 30;
  const TimeInterval range = playRange();
  const double before_s = time_s_;
  rounding_s_ = std::pow(10.0, std::floor(std::log10(std::abs(rate_) * kShown_s)));
  const double next_s = time_s_ + rate_ * dt_s;
  const bool is_in_range = rate_ > 0 ? next_s <= range.end_s : next_s >= range.begin_s;
  if (is_in_range) {
    time_s_ = next_s;
  } else if (loop_) {
    const double length_s = range.end_s - range.begin_s;
    const double beyond_s = std::fmod(next_s - range.begin_s, length_s);
    time_s_ = range.begin_s + (beyond_s < 0 ? beyond_s + length_s : beyond_s);
  } else {  // a time outside the playing range is not changed
    time_s_ = rate_ > 0 ? std::max(time_s_, range.end_s) : std::min(time_s_, range.begin_s);
    rounding_s_ = 0;
    playing_ = false;
  }
  follow(before_s);
  return time_s_;
}

std::optional<double> Timeline::untilNextStep_s() const {
  if (!playing_) return std::nullopt;
  if (is_continuous_) return 0;
  const auto time = [this](int index) { return times_s_[static_cast<std::size_t>(index)]; };
  const int now = step(), next = rate_ > 0 ? now + 1 : now - 1;
  const TimeInterval range = playRange();
  double due_s = rate_ > 0 ? range.end_s : range.begin_s;
  if (next >= 0 && next < static_cast<int>(times_s_.size())) due_s = 0.5 * (time(now) + time(next));
  return std::max(0.0, (due_s - time_s_) / rate_);
}

}  // namespace emscape::playback
