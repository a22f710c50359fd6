#include "recording/tracks/table_cells.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace emscape::interop {
namespace {

/// True if each comma has three digits after it, and then no further one.
bool haveThreeDigits(const std::string& text) {
  for (std::size_t at = text.find(','); at != std::string::npos; at = text.find(',', at + 1)) {
    const std::size_t end = text.find_first_not_of("0123456789", at + 1);
    if (std::min(end, text.size()) - at != 4) return false;
  }
  return true;
}

}  // namespace

double secondsOf(double time) {
  constexpr double kUnixTime_ms = 1e11, kUnixTime_us = 1e14, kUnixTime_ns = 1e17;
  return time > kUnixTime_ns   ? time / 1e9
         : time > kUnixTime_us ? time / 1e6
         : time > kUnixTime_ms ? time / 1000
                               : time;
}

bool isCompactDate(std::string_view text) {
  constexpr std::size_t kDigits = 14;
  return text.size() >= kDigits && (text.substr(0, 2) == "19" || text.substr(0, 2) == "20") &&
         text.find_first_not_of("0123456789") >= kDigits && (text.size() == kDigits || text[kDigits] == '.');
}

double degreesOf(double degrees_minutes) {
  const double minutes = std::fmod(degrees_minutes, 100);
  return (degrees_minutes - minutes) / 100 + minutes / 60;
}

bool isFill(double number) {
  constexpr double kLongestNines = 1e9, kHighest_m = 1e5;
  for (double nines = 9999; nines < kLongestNines; nines = 10 * nines + 9) {
    if (number == -nines || (number == nines && nines >= kHighest_m - 1)) return true;
  }
  return number == -32768;
}

std::string joinedAngle(const std::string& text) {
  std::string joined;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_blank = text[i] == ' ';
    const bool is_before_digit = i + 1 < text.size() && text[i + 1] >= '0' && text[i + 1] <= '9';
    const bool is_after_digit = !joined.empty() && joined.back() >= '0' && joined.back() <= '9';
    if (!is_blank) joined += text[i];
    if (is_blank && is_before_digit && is_after_digit) joined += ':';
  }
  return joined;
}

std::optional<double> offsetOf_s(const std::string& cell) {
  constexpr double kHour_s = 3600, kMinute_s = 60, kMost_h = 14;
  std::string text;
  for (const char c : cell) {
    if (std::isdigit(static_cast<unsigned char>(c)) != 0 || c == ':' || c == '+' || c == '-') text += c;
  }
  const bool is_west = !text.empty() && text.front() == '-';
  if (is_west || (!text.empty() && text.front() == '+')) text.erase(0, 1);
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos && text.size() == 4) text.insert(2, ":");
  const std::size_t middle = text.find(':');
  const std::string hours = text.substr(0, middle),
                    minutes = middle < text.size() ? text.substr(middle + 1) : "0";
  const auto isNumber = [](const std::string& digits) {
    return !digits.empty() && digits.size() <= 2 &&
           digits.find_first_not_of("0123456789") == std::string::npos;
  };
  if (cell.find_first_of(".,") != std::string::npos || !isNumber(hours) || !isNumber(minutes))
    return std::nullopt;
  const double hours_of_day = std::stod(hours) + std::stod(minutes) * kMinute_s / kHour_s;
  if (hours_of_day > kMost_h || std::stod(minutes) >= kMinute_s) return std::nullopt;
  return (is_west ? -1 : 1) * hours_of_day * kHour_s;
}

std::string TrackTable::nameOf(Column column) const {
  return header.empty() ? "" : printableText(header[columns.at(column).index]);
}

std::optional<double> TrackTable::numberOf(std::string text, bool is_coordinate) const {
  const std::size_t comma = text.rfind(',');
  if (comma == std::string::npos) return numberIn(text);
  if (separator != ',') {
    if (text.find('.') < comma) text.erase(std::remove(text.begin(), text.end(), '.'), text.end());
  } else if (!is_coordinate && haveThreeDigits(text)) {
    text.erase(std::remove(text.begin(), text.end(), ','), text.end());
  }
  std::replace(text.begin(), text.end(), ',', '.');
  return numberIn(text);
}

const std::string* TrackTable::cellOf(const std::vector<std::string>& cells, Column column) const {
  const auto found = columns.find(column);
  if (found == columns.end() || found->second.index >= cells.size()) return nullptr;
  const std::string& cell = cells[found->second.index];
  return cell.empty() ? nullptr : &cell;
}

std::optional<double> TrackTable::valueOf(const std::vector<std::string>& cells, Column column) const {
  const std::string* const cell = cellOf(cells, column);
  const bool is_coordinate = column == Column::latitude || column == Column::longitude;
  const auto number = cell == nullptr ? std::nullopt : numberOf(*cell, is_coordinate);
  if (!number) return std::nullopt;
  const TableColumn& told = columns.at(column);
  return told.is_degrees_minutes ? degreesOf(*number) : *number * told.factor;
}

}  // namespace emscape::interop
