/// Points between thousands in tables whose numbers have decimal commas.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "emscape/base/error.h"

namespace emscape {

/// What separates decimals in the numbers of a table: in "950,5" and "1.050" a point is hardly decimal.
class DecimalSigns {
 public:
  /// @param cell  of a column of numbers
  void see(std::string_view cell, const SourceLocation& location) {
    if (cell.empty() || cell.find_first_not_of("+-0123456789.,") != std::string_view::npos) return;
    const bool has_comma = cell.find(',') != std::string_view::npos;
    std::string& first = has_comma ? with_comma_ : with_point_;
    if (!first.empty() || (!has_comma && !mayBeThousands(cell))) return;
    first = cell;
    if (!has_comma) location_ = location;
  }

  /// @throws Error (bad_input) at the first number whose point may be one between thousands, if others have
  /// decimal commas
  void require() const {
    if (with_comma_.empty() || with_point_.empty()) return;
    throw Error(ErrorCode::bad_input, location_,
                fmt::format("'{}': is its point decimal, or between thousands? Other numbers have decimal "
                            "commas ('{}'); write it without a point, or with a comma",
                            with_point_, with_comma_));
  }

 private:
  /// One to three digits, not 0 first, then points with three digits each.
  static bool mayBeThousands(std::string_view cell) {
    if (cell.front() == '+' || cell.front() == '-') cell.remove_prefix(1);
    const std::size_t point = cell.find('.');
    if (point == std::string_view::npos || point == 0 || point > 3 || cell.front() == '0') return false;
    for (std::size_t i = point; i < cell.size(); ++i) {
      if ((cell[i] == '.') != ((i - point) % 4 == 0)) return false;
    }
    return (cell.size() - point) % 4 == 0;
  }

  std::string with_comma_, with_point_;
  SourceLocation location_;
};

}  // namespace emscape
