#include "playback/editing/timeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "emscape/base/error.h"
#include "emscape/render/annotate/legend.h"

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

/// "hh:mm" or "hh:mm:ss.s" as seconds after midnight; none for another text.
std::optional<double> secondsOfDay(const std::string& text) {
  int hours = -1, minutes = -1, read = 0;
  double seconds = 0;
  const char* rest = text.c_str();
  if (std::sscanf(rest, "%2d:%2d%n", &hours, &minutes, &read) != 2) return std::nullopt;
  rest += read;
  read = 0;
  if (*rest != '\0' && (std::sscanf(rest, ":%lf%n", &seconds, &read) != 1 || rest[read] != '\0')) {
    return std::nullopt;
  }
  if (hours < 0 || hours > 23 || minutes < 0 || minutes > 59 || !(seconds >= 0 && seconds < 60)) {
    return std::nullopt;
  }
  return 3600.0 * hours + 60.0 * minutes + seconds;
}

/// Of the steps' span.
constexpr double kMinVisible = 1e-6;

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
  // By whole numbers of steps, so that no error accumulates.
  for (double n = std::ceil(from_s / step_s - 1e-9); n * step_s <= to_s + 1e-9 * step_s; ++n) {
    const double time_s = n * step_s + 0.0;  // not -0
    const std::string text = render::tickText(time_s, step_s);
    ticks.push_back({time_s, text, timeOfDay(scenario::utcAt(clock, time_s), text)});
  }
  return ticks;
}

double Timeline::parseTime_s(const std::string& text) const {
  constexpr double kDay_s = 86400;
  char* end = nullptr;
  const double seconds = std::strtod(text.c_str(), &end);
  if (!text.empty() && *end == '\0' && std::isfinite(seconds)) return seconds;
  const std::optional<double> wanted_s = secondsOfDay(text);
  if (epoch_utc_.empty() || !wanted_s) {
    throw Error(ErrorCode::bad_input, fmt::format("time '{}': expected seconds{}", text,
                                                  epoch_utc_.empty() ? "" : " or hh:mm[:ss] in UTC"));
  }
  const std::string begin = scenario::utcAt({epoch_utc_, 0, 1}, begin_s());
  const double begin_of_day_s = secondsOfDay(timeOfDay(begin, ".000")).value_or(0);
  const double after_begin_s = std::fmod(*wanted_s - begin_of_day_s + kDay_s, kDay_s);
  return begin_s() + after_begin_s;
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
}

void Timeline::stepBy(int steps) {
  const auto count = static_cast<int>(times_s_.size());
  goToStep(step() + std::clamp(steps, -count, count));
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

void Timeline::changeRate(int direction) {
  std::vector<double> rates = playRates();
  for (const double rate : playRates()) rates.push_back(-rate);
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
  const TimeInterval range = playRange();
  const double before_s = time_s_;
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
    playing_ = false;
  }
  follow(before_s);
  return time_s_;
}

std::optional<double> Timeline::untilNextStep_s() const {
  if (!playing_) return std::nullopt;
  const auto time = [this](int index) { return times_s_[static_cast<std::size_t>(index)]; };
  const int now = step(), next = rate_ > 0 ? now + 1 : now - 1;
  const TimeInterval range = playRange();
  double due_s = rate_ > 0 ? range.end_s : range.begin_s;
  if (next >= 0 && next < static_cast<int>(times_s_.size())) due_s = 0.5 * (time(now) + time(next));
  return std::max(0.0, (due_s - time_s_) / rate_);
}

}  // namespace emscape::playback
