/// Model of a time line: what is on it, where the hand is, and how it moves. No drawing, no clock.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emscape/scenario/scenario.h"

namespace emscape::playback {

/// A mark at a round time.
struct TimelineTick {
  double time_s = 0;
  std::string seconds_text;  ///< "12.5"
  std::string utc_text;      ///< "06:00:12.5", with as many decimals; empty without an epoch
};

/// When an emitter radiates, within the span of the steps.
struct ActivityBar {
  std::string emitter;
  std::vector<scenario::TimeInterval> intervals;  ///< ascending, without overlap; one for always
};

/// The rates that faster() and slower() go through, ascending, in scenario seconds in a second.
const std::vector<double>& playRates();
/// The nearest of them by ratio, with the sign of `rate`; the slowest for 0.
double snappedRate(double rate);

/// Time moves between the first and the last step. One thread uses it.
class Timeline {
 public:
  /// @param times_s    of the steps, ascending, at least one
  /// @param epoch_utc  ISO 8601; empty: no UTC texts
  explicit Timeline(std::vector<double> times_s, std::string epoch_utc = "",
                    std::vector<ActivityBar> bars = {});
  /// Steps of a source that shows a scenario.
  Timeline(std::vector<double> times_s, const scenario::Scenario& scenario);

  const std::vector<double>& times_s() const { return times_s_; }
  double begin_s() const { return times_s_.front(); }
  double end_s() const { return times_s_.back(); }
  const std::vector<ActivityBar>& bars() const { return bars_; }

  /// About `count` ticks at round times (1, 2, 5, 10, 15, 30 s, min, h, ...) within an interval.
  /// @param from_s, to_s  from_s < to_s
  std::vector<TimelineTick> ticks(double from_s, double to_s, int count) const;

  /// Steps that need not be computed, as spans of times that reach halfway to the steps around.
  /// @param steps  indices, ascending
  std::vector<scenario::TimeInterval> cachedSpans(const std::vector<int>& steps) const;

  // The hand
  double time_s() const { return time_s_; }
  /// Clamped to the steps' span; of a time that is not a number nothing happens.
  void seek(double time_s);
  /// The index of the step nearest to a time; the earlier of two as near.
  int nearestStep(double time_s) const;
  /// The step that is shown.
  int step() const { return nearestStep(time_s_); }
  /// To the step that lies so many after the one shown (before: negative), at most to the last or first.
  /// Stops playing.
  void stepBy(int steps);
  void goToFirst() { goToStep(0); }
  void goToLast() { goToStep(static_cast<int>(times_s_.size()) - 1); }

  // Playing
  bool playing() const { return playing_; }
  /// At the end that the rate leads to, playing begins anew from the other one.
  void play();
  void pause() { playing_ = false; }
  double rate() const { return rate_; }
  /// Any rate but 0, which is not taken; negative: backwards.
  void setRate(double rate);
  /// The next of playRates() in the direction that time goes.
  void faster();
  void slower();
  void reverse() { rate_ = -rate_; }
  bool loop() const { return loop_; }
  void setLoop(bool loop) { loop_ = loop; }

  /// Lets time pass while it plays. At an end it goes on from the other one in a loop, else it stops there.
  /// @param dt_s  of the user's clock, >= 0
  /// @return time_s()
  double advance(double dt_s);

 private:
  void goToStep(int step);

  std::vector<double> times_s_;
  std::string epoch_utc_;
  std::vector<ActivityBar> bars_;
  double time_s_;
  double rate_ = 1;
  bool playing_ = false;
  bool loop_ = false;
};

/// When each emitter of a scenario radiates between two times.
std::vector<ActivityBar> activityBarsOf(const scenario::Scenario& scenario, double from_s, double to_s);

}  // namespace emscape::playback
