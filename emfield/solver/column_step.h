/// The part of the columns that an update computes while emitters move.
#pragma once

namespace emscape::emfield {

/// Chooses the step between computed columns from measured times, so that an update takes at most a given
/// time, if that is possible.
struct ColumnPace {
  /// Largest step: a sixteenth of the columns.
  static constexpr int kMaxStep = 4;

  double goal_ms = 0;  ///< of an update; 0: every column is computed
  double rest_ms = 0;  ///< of the last update, without the columns
  int step = 1;        ///< the last one

  /// @param every_column_ms  time that all columns of the emitters that moved would take; 0: unknown
  void choose(double every_column_ms) {
    // A smaller step than before must hold the time with a margin, so that steps do not alternate.
    constexpr double kMargin = 0.7;
    // A larger step gains nothing where the columns take less than this part of the rest.
    constexpr double kSmallPart = 0.1;
    const int before = step;
    const auto suffices = [&](int n) {
      const double columns_ms = every_column_ms / (n * n);
      return columns_ms <= kSmallPart * rest_ms ||
             rest_ms + columns_ms <= goal_ms * (n < before ? kMargin : 1);
    };
    for (step = 1; goal_ms > 0 && every_column_ms > 0 && step < kMaxStep && !suffices(step);) step *= 2;
  }
};

}  // namespace emscape::emfield
