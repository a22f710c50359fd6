/// Signs between thousands in tables whose numbers have the other sign before decimals.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

#include "emscape/base/error.h"

namespace emscape {

/// What separates decimals in the numbers of a table: in "950,5" and "1.050" a point is hardly decimal, in
/// "50.10" and "35,000" a comma hardly.
class DecimalSigns {
 public:
  /// @param cell  of a column of numbers
  void see(std::string_view cell, const SourceLocation& location) {
    if (cell.empty() || cell.find_first_not_of("+-0123456789.,") != std::string_view::npos) return;
    // Of both signs the last is decimal, and the other between thousands.
    const std::size_t comma = cell.rfind(','), point = cell.rfind('.');
    const bool has_both = comma != std::string_view::npos && point != std::string_view::npos;
    if (!has_both || comma > point) see(comma_, ',', cell, location);
    if (!has_both || point > comma) see(point_, '.', cell, location);
  }

  /// @param cell  of a column of coordinates, in which no comma is between thousands
  void seeCoordinate(std::string_view cell) {
    if (comma_.decimal.empty() && cell.find(',') != std::string_view::npos) comma_.decimal = cell;
  }

  /// @throws Error (bad_input) at the first number whose sign may be one between thousands, if others have
  /// the other sign before decimals
  void require() const {
    require(point_, "point", comma_, "comma");
    require(comma_, "comma", point_, "point");
  }

  /// @throws Error (bad_input) at the first number whose comma may be one between thousands, if none is
  /// surely decimal
  void requireClearComma() const {
    if (comma_.unclear.empty() || !comma_.decimal.empty()) return;
    throw Error(ErrorCode::bad_input, comma_.location,
                fmt::format("'{}': is its comma decimal, or between thousands? Write numbers without commas, "
                            "with points before decimals",
                            comma_.unclear));
  }

  /// The same of a table whose cells are separated by commas, where one in quotes is between thousands.
  void requireOneComma() const {
    if (comma_.unclear.empty() || comma_.decimal.empty()) return;
    throw Error(ErrorCode::bad_input, comma_.location,
                fmt::format("'{}': is its comma decimal, or between thousands? '{}' has a decimal one; write "
                            "numbers without commas, with points before decimals",
                            comma_.unclear, comma_.decimal));
  }

 private:
  struct Sign {
    std::string decimal, unclear;  ///< the first number with one before decimals, and with one that may be
    SourceLocation location;       ///< of the second
  };

  static void see(Sign& sign, char is, std::string_view cell, const SourceLocation& location) {
    if (cell.find(is) == std::string_view::npos) return;
    const bool is_unclear = mayBeThousands(cell, is);
    std::string& first = is_unclear ? sign.unclear : sign.decimal;
    if (!first.empty()) return;
    first = cell;
    if (is_unclear) sign.location = location;
  }
  static void require(const Sign& unclear, const char* sign, const Sign& other, const char* other_sign) {
    const std::string& decimal = other.decimal.empty() ? other.unclear : other.decimal;
    if (unclear.unclear.empty() || decimal.empty()) return;
    throw Error(ErrorCode::bad_input, unclear.location,
                fmt::format("'{}': is its {} decimal, or between thousands? Other numbers have decimal {}s "
                            "('{}'); write it without a {}, or with a {}",
                            unclear.unclear, sign, other_sign, decimal, sign, other_sign));
  }
  /// One to three digits, not 0 first, then signs with three digits each.
  static bool mayBeThousands(std::string_view cell, char sign) {
    if (cell.front() == '+' || cell.front() == '-') cell.remove_prefix(1);
    const std::size_t first = cell.find(sign);
    if (first == std::string_view::npos || first == 0 || first > 3 || cell.front() == '0') return false;
    for (std::size_t i = first; i < cell.size(); ++i) {
      if ((cell[i] == sign) != ((i - first) % 4 == 0)) return false;
    }
    return (cell.size() - first) % 4 == 0;
  }

  Sign comma_, point_;
};

}  // namespace emscape
