/// The part of a field that is computed while emitters move.
#pragma once

#include <string>

namespace emscape::playback {

/// As pictures while they change have a part of the rays, fields of moving emitters have a part of the
/// columns where all of them take too long (FieldSolver::setTimeGoal()). A field that rests is completed.
struct BusyField {
  static constexpr double kGoal_ms = 250;   ///< of a field
  static constexpr double kQuiet_ms = 150;  ///< without requests, after which a field is completed
};

/// "field in every second column", of Frame::column_step above 1.
inline std::string columnsText(int column_step) {
  return std::string("field in every ") + (column_step == 2 ? "second" : "fourth") + " column";
}

}  // namespace emscape::playback
