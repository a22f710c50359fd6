/// How the numbers of fields outside of What if are written and read.
#pragma once

#include <functional>
#include <limits>
#include <string>

#include "emscape/base/units.h"

namespace emscape::view {

/// "altitude 1500 m": read with the unit, another unit of the same dimension, or without a unit.
struct NumberForm {
  std::string before = {};      ///< "altitude "
  std::string unit = {};        ///< plain, of the value: "m"; may be empty
  std::string after = {};       ///< " above ground"
  int decimals = -1;            ///< less than 0: five significant digits
  std::string shown_unit = {};  ///< in which it is written; empty: `unit`
  double shown_factor = 1;      ///< value of 1 `shown_unit`
  FieldUnit field_unit{};       ///< of values of a field, in which they are written
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
  /// Reads another grammar than that of numbers with a unit, such as that of times, and checks the range.
  std::function<double(const std::string& text)> read = {};

  std::string textOf(double value) const;
  /// @throws Error (bad_input) for a text that is no such number, and for values out of the limits
  double valueOf(const std::string& text) const;
};

}  // namespace emscape::view
