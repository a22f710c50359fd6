#include "recording/tracks/table_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "recording/common/dates.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"

namespace emscape::interop {

std::optional<double> TableTimes::of(const std::vector<std::string>& cells, const std::string& location) {
  const auto bad = [&](const std::string& reason) {
    countBad(recorder_.tally(), location, reason);
    return std::nullopt;
  };
  const std::string* const told = table_.cellOf(cells, Column::time);
  if (told == nullptr) return bad("it has no time");
  const TableColumn& column = table_.columns.at(Column::time);
  const std::string* const date = table_.cellOf(cells, Column::date);
  const bool is_compact = date == nullptr && !column.has_unit && isCompactDate(*told);
  if (date == nullptr && !is_compact) {
    if (const auto number = table_.numberOf(*told)) {
      const double time = *number * column.factor;
      if (column.day_of_1970 > 0 || column.begin_s > 0) {
        is_utc_ = true;
        return column.begin_s > 0 ? *number + column.begin_s
                                  : (*number - column.day_of_1970) * kSecondsPerDay;
      }
      recorder_.mayBeDays(!column.has_unit);
      if (!column.has_unit && time == std::floor(time)) {
        if (plain_times_++ == 0) first_time_ = secondsOf(time);
        last_time_ = secondsOf(time);
      }
      if (time > kFirstUnixTime_s) {
        is_utc_ = true;
        tellGpsName();
      }
      return secondsOf(time);
    }
  }
  std::string text = is_compact        ? told->substr(0, 8) + "T" + told->substr(8)
                     : date == nullptr ? *told
                                       : *date + " " + *told;
  double offset_s = 0;
  if (const std::string* const cell = table_.cellOf(cells, Column::utc_offset);
      cell != nullptr && cell->find_first_not_of(" ") != std::string::npos && !isUtc(text)) {
    const std::optional<double> offset = offsetOf_s(*cell);
    if (!offset)
      return bad(
          fmt::format("its offset from UTC '{}' cannot be read; it is one as -04:00, in hours and minutes",
                      printableText(*cell)));
    offset_s = *offset;
    recorder_.assume(fmt::format("times are local: column '{}' gives their offset from UTC",
                                 table_.nameOf(Column::utc_offset)));
  }
  const DateOrder order = date == nullptr ? column.order : table_.columns.at(Column::date).order;
  if (const auto time_s = utcSeconds(text, order)) {
    is_utc_ = true;
    if (table_.columns.count(Column::utc_offset) == 0 && !isUtc(text))
      recorder_.assume(std::string(kUtcWithoutZone) +
                       ", or name a column of offsets: --columns (or 'columns' of a track) utc_offset=NAME");
    return *time_s - offset_s;
  }
  if (needsDateOrder(text)) {
    throw Error(
        ErrorCode::bad_input, {table_.file, 0, 0},
        fmt::format(
            "{}: the date '{}' may begin with its day or its month; tell it with columns: {}=NAME:dmy "
            "or {}=NAME:mdy",
            location, printableText(text), roleOf(date == nullptr ? Column::time : Column::date),
            roleOf(date == nullptr ? Column::time : Column::date)));
  }
  if (const auto time_s = date == nullptr ? timeOfDay(text) : std::nullopt) return *time_s - offset_s;
  return bad(
      fmt::format("its time '{}' cannot be read; it is one as 2026-06-01T06:00:00Z or "
                  "2026-06-01 08:00:00+02:00, in seconds since 1970 or of the scenario, or hh:mm:ss",
                  printableText(text)));
}

bool TableTimes::isUtc(const std::string& text) const {
  std::string names = lowerCase(table_.nameOf(Column::time));
  if (table_.columns.count(Column::date) != 0) names += " " + lowerCase(table_.nameOf(Column::date));
  for (const char* const word : {"utc", "gmt", "zulu", "basedatetime"}) {  // the last of MarineCadastre's AIS
    if (names.find(word) != std::string::npos) return true;
  }
  return hasZone(text);
}

std::optional<double> TableTimes::timeOfDay(const std::string& text) {
  if (is_utc_ || std::count(text.begin(), text.end(), ':') != 2) return std::nullopt;
  const auto time_s = utcSeconds("1970-01-01 " + text);
  if (!time_s) return std::nullopt;
  has_times_of_day_ = true;
  if (*time_s + day_s_ < last_of_day_s_ - kSecondsPerDay / 2) day_s_ += kSecondsPerDay;
  last_of_day_s_ = *time_s + day_s_;
  return last_of_day_s_;
}

void TableTimes::tellGpsName() {
  const std::string name = table_.nameOf(Column::time);
  if (lowerCase(name).find("gps") == std::string::npos) return;
  recorder_.assume(
      fmt::format("time of column '{0}' taken as since 1970; if it is GPS time, since 1980, columns tell "
                  "it: time={0}:gps",
                  name));
}

void TableTimes::tellLongSteps(double path_deg, ReadingTally& tally) const {
  constexpr double kLongStep_s = 3e4, kCreeping_mps = 0.05, kDegree_m = 111e3;
  const double span_s = last_time_ - first_time_;
  if (plain_times_ < 3 || span_s < kLongStep_s * static_cast<double>(plain_times_ - 1) || path_deg == 0 ||
      path_deg * kDegree_m > kCreeping_mps * span_s)
    return;
  const std::string name = table_.nameOf(Column::time);
  tally.notes.push_back(
      fmt::format("times of column '{0}' are taken as seconds; they are {1:.6g} apart on average: if they "
                  "are in microseconds or milliseconds, columns tell it: time={0}:us or time={0}:ms",
                  name, span_s / static_cast<double>(plain_times_ - 1)));
}

}  // namespace emscape::interop
