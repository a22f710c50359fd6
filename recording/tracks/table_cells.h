/// Cells of tables of positions: what their texts and numbers stand for.
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "recording/common/text.h"
#include "recording/tracks/table_columns.h"

namespace emscape::interop {

/// Above this number a time is since 1970.
constexpr double kFirstUnixTime_s = 1e8;

/// A time since 1970 in seconds; its size tells whether it is in seconds, milli-, micro- or nanoseconds.
double secondsOf(double time);
/// A date and time in digits alone, YYYYMMDDhhmmss. As a number it would be one of the 26th century.
bool isCompactDate(std::string_view text);
/// DDMM.mmmm in degrees.
double degreesOf(double degrees_minutes);
/// True for a number that stands for none: nines, as -9999 or 9999999, and -32768.
bool isFill(double number);
/// An angle whose parts are apart, "52 06.1 N", as one word, "52:06.1N".
std::string joinedAngle(const std::string& text);

/// A table: its columns, and what the cells of its rows hold.
struct TrackTable {
  std::string file;
  std::vector<std::string> header;  ///< empty: the format has none
  Columns columns;
  char separator = ',';

  /// Of a column in the header, for messages; empty without a header.
  std::string nameOf(Column column) const;
  /// The cell of a column; null if the row has none, or nothing in it.
  const std::string* cellOf(const std::vector<std::string>& cells, Column column) const;
  /// In tables separated by semicolons or tabs the comma may be decimal, with dots between thousands. In
  /// tables separated by commas a quoted one of a coordinate is decimal, others stand between thousands if
  /// three digits follow each.
  std::optional<double> numberOf(std::string text, bool is_coordinate = false) const;
  /// In metres, degrees or seconds.
  std::optional<double> valueOf(const std::vector<std::string>& cells, Column column) const;
};

/// A column without a role, as its rows show it.
struct UnusedColumn {
  std::size_t index = 0;
  std::string last;             ///< cell of the row before
  std::set<std::string> texts;  ///< the first kMaxTexts
  long long rows = 0;
  long long turns = 0;  ///< rows whose cell is another one than that before
  bool has_text = false;

  static constexpr std::size_t kMaxTexts = 1000;

  void take(const std::string& cell) {
    ++rows;
    if (cell == last) return;
    ++turns;
    last = cell;
    has_text = has_text || (!cell.empty() && !numberIn(cell));
    if (texts.size() < kMaxTexts) texts.insert(cell);
  }
  /// True if cells repeat as the names of several objects do.
  bool mayBeNames() const {
    return texts.size() > 1 && texts.size() < kMaxTexts && 2 * static_cast<long long>(texts.size()) <= rows;
  }
};

/// Seconds of an offset from UTC as -4, +05:30 or UTC-0400; none: it is not one.
std::optional<double> offsetOf_s(const std::string& cell);

}  // namespace emscape::interop
