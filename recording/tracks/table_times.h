/// Times of a table of positions: of the scenario, since 1970, or dates and times of day.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recording/common/track_recorder.h"
#include "recording/tracks/table_cells.h"

namespace emscape::interop {

class TableTimes {
 public:
  /// @param recorder  is told of assumptions and bad rows
  TableTimes(const TrackTable& table, TrackRecorder& recorder) : table_(table), recorder_(recorder) {}

  /// The time of a row (s); none: it is counted as bad.
  /// @throws Error (bad_input) for a date whose order is not known
  std::optional<double> of(const std::vector<std::string>& cells, const std::string& location);
  bool areUtc() const { return is_utc_; }
  bool areOfDay() const { return has_times_of_day_; }
  /// Whole numbers without a unit that are far apart, in which an object creeps, are no seconds.
  /// @param path_deg  way of all rows, roughly
  void tellLongSteps(double path_deg, ReadingTally& tally) const;

 private:
  /// True if a time, or the name of its column, says that it is UTC or has its own offset.
  bool isUtc(const std::string& text) const;
  /// hh:mm:ss without a date, as times of a day that is not told, and of the next ones where they fall.
  std::optional<double> timeOfDay(const std::string& text);
  void tellGpsName();

  const TrackTable& table_;
  TrackRecorder& recorder_;
  long long plain_times_ = 0;  ///< whole numbers without a unit, since no known time
  double first_time_ = 0, last_time_ = 0;
  double day_s_ = 0, last_of_day_s_ = 0;
  bool is_utc_ = false, has_times_of_day_ = false;
};

}  // namespace emscape::interop
