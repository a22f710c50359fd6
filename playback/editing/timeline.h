/// Model of a time line: its contents, the current time and its motion. No drawing, no clock.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"

namespace emscape::playback {

/// A mark at a round time.
struct TimelineTick {
  double time_s = 0;
  std::string text;      ///< "12.5 s"; on long time lines "26:00", "1 d 02:00"
  std::string utc_text;  ///< "06:00:12.5", with as many decimals; with the date where it changes, and in days
                         ///< "2026-06-02"; empty without an epoch
};

/// The active intervals of an emitter within the span of the steps.
struct ActivityBar {
  std::string emitter;
  std::vector<scenario::TimeInterval>
      intervals;  ///< ascending, without overlap; one interval if always active
};

/// The usual rates, ascending, in scenario seconds per second; negative rates (backwards) are not listed.
const std::vector<double>& playRates();

/// Time is between the first and the last step. A continuous time line shows all times, others those of
/// steps. For one thread.
class Timeline {
 public:
  /// No steps: nothing moves before setSteps().
  Timeline() = default;
  /// @param times_s    of the steps, ascending
  /// @param epoch_utc  ISO 8601; empty: no UTC texts
  explicit Timeline(std::vector<double> times_s, std::string epoch_utc = "",
                    std::vector<ActivityBar> bars = {});
  /// Steps of a source that shows a scenario.
  Timeline(std::vector<double> times_s, const scenario::Scenario& scenario);

  /// Sets other steps, ascending. The current time, the playing range and the visible part are clamped to the
  /// new steps.
  void setSteps(std::vector<double> times_s);
  /// Sets whether times between the steps are shown; false at first.
  void setContinuous(bool is_continuous) { is_continuous_ = is_continuous; }
  bool isContinuous() const { return is_continuous_; }
  /// Sets the epoch and the emitters' active intervals.
  void setScenario(const scenario::Scenario& scenario);

  const std::vector<double>& times_s() const { return times_s_; }
  double begin_s() const { return times_s_.empty() ? 0 : times_s_.front(); }
  double end_s() const { return times_s_.empty() ? 0 : times_s_.back(); }
  const std::vector<ActivityBar>& bars() const { return bars_; }
  /// True if there are at least two times.
  bool hasSpan() const { return begin_s() < end_s(); }

  /// About `count` ticks at round times (1, 2, 5, 10, 15, 30 s, min, h, ...) within an interval.
  /// @param from_s, to_s  from_s < to_s
  std::vector<TimelineTick> ticks(double from_s, double to_s, int count) const;

  /// As scenario::parseTime_s(), within the span of the steps if there are any.
  double parseTime_s(const std::string& text) const;
  /// @throws Error (bad_input) that names the span of the steps if a time is outside of it
  void requireTime(double time_s) const;

  /// Cached steps, as intervals that reach halfway to the neighbouring steps.
  /// @param steps  indices, ascending
  std::vector<scenario::TimeInterval> cachedSpans(const std::vector<int>& steps) const;

  // The part that is drawn
  /// All of the steps' span at first.
  scenario::TimeInterval visible() const;
  /// Sets the visible part; it is moved into the span and is at least a millionth of it long. No effect
  /// unless from_s < to_s.
  void setVisible(double from_s, double to_s);
  /// @param factor   of the visible length, > 0: below 1 shows less
  /// @param about_s  time that keeps its position
  void zoom(double factor, double about_s);
  void pan(double by_s);
  void showAll() { visible_.reset(); }
  /// The set value; none: the span of all steps.
  const std::optional<scenario::TimeInterval>& visiblePart() const { return visible_; }

  // The current time
  double time_s() const { return time_s_; }
  /// Clamped to the steps' span; NaN has no effect. Playing continues from there.
  void seek(double time_s);
  /// The index of the step nearest to a time; of two equally near, the earlier.
  int nearestStep(double time_s) const;
  /// The nearest step.
  int step() const { return nearestStep(time_s_); }
  /// Time of the nearest step; without steps, time_s().
  double step_s() const { return times_s_.empty() ? time_s_ : times_s_[static_cast<std::size_t>(step())]; }
  /// The time to show: that of a step, or of a continuous time line any. While playing it is rounded to a
  /// decimal that a thirtieth of a second of the user's clock shows.
  double asked_s() const;
  /// Moves by a number of steps from the present time (negative: backwards), at most to the first or last.
  /// Stops playing.
  void stepBy(int steps);
  void goToFirst() { goToStep(0); }
  void goToLast() { goToStep(static_cast<int>(times_s_.size()) - 1); }

  // Playing
  bool playing() const { return playing_; }
  /// Starts playing. At the end in the direction of the rate, or outside the playing range, it starts from
  /// the other end.
  void play();
  /// Stops playing, at asked_s().
  void pause();
  /// Range of playing; the span of all steps at first.
  scenario::TimeInterval playRange() const;
  /// Sets the range of playing; its ends are moved to the nearest steps, and it has at least two steps.
  void setPlayRange(double begin_s, double end_s);
  /// Sets one end of the range; it stays at least a step before or after the other end.
  void setPlayBegin(double time_s);
  void setPlayEnd(double time_s);
  void playAll() { play_range_.reset(); }
  /// The set value; none: the span of all steps.
  const std::optional<scenario::TimeInterval>& playPart() const { return play_range_; }
  double rate() const { return rate_; }
  /// Sets the rate. 0 is ignored; negative: backwards.
  void setRate(double rate);
  /// Changes to the next usual rate above (1) or below (-1). Below the slowest follow the negative rates.
  void changeRate(int direction);
  /// playRates(), and faster ones if steps are long.
  std::vector<double> usualRates() const;
  /// Steps per second of the user's clock at a rate; 0 without a span.
  double stepsPerSecond(double rate) const;
  /// True if steps are so long that rates are better understood in steps per second.
  bool hasLongSteps() const;
  void reverse() { rate_ = -rate_; }
  bool loop() const { return loop_; }
  void setLoop(bool loop) { loop_ = loop; }

  /// Advances the time while playing. At an end of the playing range it continues from the other end if
  /// looping, else it stops. The visible part follows the current time.
  /// @param dt_s  of the user's clock, >= 0
  /// @return time_s()
  double advance(double dt_s);
  /// Seconds of the user's clock until another step is shown; none while it does not play, 0 if it is
  /// continuous.
  std::optional<double> untilNextStep_s() const;

 private:
  void goToStep(int step);
  void setPlaySteps(int first, int last);
  void follow(double before_s);
  scenario::TimeInterval span() const { return {begin_s(), end_s()}; }

  std::vector<double> times_s_;
  std::string epoch_utc_;
  std::vector<ActivityBar> bars_;
  std::optional<scenario::TimeInterval> visible_, play_range_;  // none: the whole span
  double time_s_ = 0;
  double rounding_s_ = 0;  // of asked_s(); 0: none
  double rate_ = 1;
  bool playing_ = false;
  bool loop_ = false;
  bool is_continuous_ = false;
};

/// The active intervals of each emitter of a scenario between two times.
std::vector<ActivityBar> activityBarsOf(const scenario::Scenario& scenario, double from_s, double to_s);

}  // namespace emscape::playback
