/// The time that is asked for: playing, stepping, rate and loop over the steps of a series.
#pragma once

#include <optional>
#include <vector>

namespace emscape::view {

/// One thread uses it.
class Playhead {
 public:
  /// Rates (scenario seconds in a second) that changeRate() goes through.
  static const std::vector<double>& rates();

  /// Ascending; keeps the time if it lies within. Empty: nothing can be asked for.
  void setTimes_s(std::vector<double> times_s);
  const std::vector<double>& times_s() const { return times_s_; }

  double time_s() const { return time_s_; }
  /// Index of the step that is asked for: the last one that is not after the time; -1 without steps.
  int step() const;
  /// The time of that step (s); the time itself without steps.
  double step_s() const;

  bool playing() const { return playing_; }
  /// At the end of the series it starts again from the beginning.
  void play();
  void pause() { playing_ = false; }
  double rate() const { return rate_; }
  /// @param rate > 0
  void setRate(double rate) { rate_ = rate; }
  /// To the next of rates() above or below.
  void changeRate(int direction);
  bool loop() const { return loop_; }
  void setLoop(bool on) { loop_ = on; }

  /// To the step nearest to a time; playing goes on from there.
  void seek(double time_s);
  /// By so many steps; playing ends.
  void stepBy(int steps);
  /// Lets time pass. @param elapsed_s  of the wall clock, >= 0
  void advance(double elapsed_s);
  /// Wall-clock seconds until the next step is due; none if it is not playing.
  std::optional<double> untilNextStep_s() const;

 private:
  std::vector<double> times_s_;
  double time_s_ = 0;
  double rate_ = 1;
  bool playing_ = false;
  bool loop_ = false;
};

}  // namespace emscape::view
