// Soundings of the University of Wyoming: lists of columns of 7 characters, and CSV.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text/utc.h"
#include "document/csv.h"
#include "document/text_lines.h"
#include "propagation/air/moist_air.h"
#include "scenario/air/sounding.h"

namespace emscape::scenario {
namespace {

using namespace propagation;
using document::numberIn;
using document::TextField;
using document::withoutBlanks;
using document::wordsOf;

constexpr double kEmptyCell = std::numeric_limits<double>::quiet_NaN();

/// Vapour pressure by the dew point, else by the humidity; NaN: neither is known.
double vapourOf_hpa(double temperature_k, double dew_point_c, double percent) {
  if (!std::isnan(dew_point_c)) return saturationPressure_hpa(dew_point_c + kFreezing_k);
  return percent / 100 * saturationPressure_hpa(temperature_k);
}

/// A line of a page without its tags: "<H2>72200 ...</H2>" is "72200 ...".
std::string withoutTags(std::string_view line) {
  std::string text;
  bool is_tag = false;
  for (const char c : line) {
    is_tag = is_tag || c == '<';
    if (!is_tag) text += c;
    if (c == '>') is_tag = false;
  }
  return text;
}

class WyomingList : public SoundingArchive {
 public:
  explicit WyomingList(const std::string& file) : file_(file) {
    const std::string text = soundingText(file);
    for (const std::string_view line : soundingLines(text)) lines_.push_back(withoutTags(line));
  }

  std::vector<SoundingRecord> records() const override {
    std::vector<SoundingRecord> records;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const std::size_t at = lines_[i].find(kObservations);
      if (at != std::string::npos) records.push_back(recordAt(i, at));
      if (!records.empty()) readPlace(i, records.back());
    }
    for (SoundingRecord& record : records) {
      if (record.position && std::isnan(record.position->longitude_deg)) record.position.reset();
    }
    return records;
  }

  std::vector<SoundingLevel> levelsOf(const SoundingRecord& record) const override {
    const Titles titles = titlesAt(record.first - 2);
    std::vector<SoundingLevel> levels;
    for (std::size_t i = record.first; i < record.first + record.levels; ++i) {
      SoundingLevel level;
      level.line = static_cast<int>(i) + 1;
      level.pressure_hpa = number(i, titles[kPressure]);
      level.temperature_k = number(i, titles[kTemperature]) + kFreezing_k;
      if (std::isnan(level.pressure_hpa) || std::isnan(level.temperature_k)) continue;
      requireAtmosphere(level, file_);
      level.height_msl_m = geometricHeight_m(number(i, titles[kHeight]));
      level.vapour_hpa =
          vapourOf_hpa(level.temperature_k, number(i, titles[kDewPoint]), number(i, titles[kHumidity]));
      levels.push_back(level);
    }
    return levels;
  }

 private:
  static constexpr const char* kObservations = " Observations at ";
  enum Title { kPressure, kHeight, kTemperature, kDewPoint, kHumidity, kTitles };
  struct TitleSpec {
    const char *name, *unit;
  };
  static constexpr std::array<TitleSpec, kTitles> kSpecs{
      {{"PRES", "hPa"}, {"HGHT", "m"}, {"TEMP", "C"}, {"DWPT", "C"}, {"RELH", "%"}}};
  /// Columns of a value: numbers end below the end of their title.
  struct Columns {
    const char* name = "";
    std::size_t begin = 0, end = 0;
  };
  using Titles = std::array<Columns, kTitles>;

  [[noreturn]] void fail(std::size_t index, std::size_t column, const std::string& message) const {
    throw Error(ErrorCode::bad_input, {file_, static_cast<int>(index) + 1, static_cast<int>(column) + 1},
                message);
  }

  bool isRule(std::size_t index) const {
    return index < lines_.size() && lines_[index].compare(0, 10, "----------") == 0;
  }

  /// @param at  of kObservations in "72200 Name Observations at 12Z 02 Jul 2020"
  SoundingRecord recordAt(std::size_t index, std::size_t at) const {
    SoundingRecord record;
    record.line = static_cast<int>(index) + 1;
    record.station = std::string(withoutBlanks(std::string_view(lines_[index]).substr(0, at)));
    readTime(index, at + std::string_view(kObservations).size(), record);
    std::size_t i = index + 1;
    while (i < lines_.size() && lines_[i].find("PRES") == std::string::npos) {
      if (lines_[i].find(kObservations) != std::string::npos) break;
      ++i;
    }
    if (i + 2 >= lines_.size() || lines_[i].find("PRES") == std::string::npos || !isRule(i + 2))
      fail(index, 0, "no titles PRES, HGHT, TEMP, DWPT, RELH and their units follow this heading");
    record.first = i + 3;
    std::size_t end = record.first;
    while (end < lines_.size() && !withoutBlanks(lines_[end]).empty() && !isRule(end) &&
           numberIn(wordsOf({lines_[end], 1, 1}).front().text)) {
      ++end;
    }
    record.levels = end - record.first;
    return record;
  }

  /// "12Z 02 Jul 2020"
  void readTime(std::size_t index, std::size_t column, SoundingRecord& record) const {
    constexpr const char* kMonths[] = {"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                       "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
    const std::vector<TextField> words = wordsOf({std::string_view(lines_[index]).substr(column), 1, 1});
    const auto month = words.size() < 4 ? std::end(kMonths)
                                        : std::find(std::begin(kMonths), std::end(kMonths), words[2].text);
    if (month != std::end(kMonths)) {
      const std::string_view hour = words[0].text.substr(0, words[0].text.find('Z'));
      const auto whole = [](std::string_view text) {
        const double number = numberIn(text).value_or(-1);
        return number >= 0 && number <= 9999 ? static_cast<int>(number) : -1;  // -1: no time
      };
      record.time_utc = fmt::format("{:04}-{:02}-{:02}T{:02}:00:00Z", whole(words[3].text),
                                    month - std::begin(kMonths) + 1, whole(words[1].text), whole(hour));
      if (const auto time_ms = parseUtc_ms(record.time_utc)) {
        record.time_ms = *time_ms;
        return;
      }
    }
    fail(index, column, "expected a time such as 12Z 02 Jul 2020");
  }

  /// The lines "Station latitude: 47.46" below a list.
  void readPlace(std::size_t index, SoundingRecord& record) const {
    const auto valueOf = [&](const char* name) -> std::optional<double> {
      const std::size_t at = lines_[index].find(name);
      if (at == std::string::npos) return std::nullopt;
      return numberIn(
          withoutBlanks(std::string_view(lines_[index]).substr(at + std::string_view(name).size())));
    };
    // Until its longitude is read, and if there is none, a place has none.
    if (const auto latitude_deg = valueOf("Station latitude:"))
      record.position = GeodeticPosition{*latitude_deg, std::nan(""), 0};
    if (const auto longitude_deg = valueOf("Station longitude:"); longitude_deg && record.position)
      record.position->longitude_deg = *longitude_deg;
  }

  /// The columns below the titles of a line; their units are in the next one.
  Titles titlesAt(std::size_t index) const {
    const std::size_t line = index - 1;
    Titles titles;
    std::size_t before = 0;
    for (const TextField& word : wordsOf({lines_[line], 1, 1})) {
      const std::size_t end = static_cast<std::size_t>(word.column) - 1 + word.text.size();
      for (std::size_t i = 0; i < kTitles; ++i) {
        if (word.text == kSpecs[i].name) titles[i] = {kSpecs[i].name, before, end};
      }
      before = end;
    }
    for (std::size_t i = 0; i < kTitles; ++i) {
      const Columns& columns = titles[i];
      if (columns.end == 0) {
        if (i == kHumidity || i == kDewPoint) continue;
        fail(line, 0, fmt::format("no title {}", kSpecs[i].name));
      }
      const std::string_view unit = cell(index, columns);
      if (unit != kSpecs[i].unit)
        fail(index, columns.begin,
             fmt::format("{} is in '{}'; expected {}", kSpecs[i].name, unit, kSpecs[i].unit));
    }
    return titles;
  }

  std::string_view cell(std::size_t index, const Columns& columns) const {
    const std::string_view line = lines_[index];
    if (columns.begin >= line.size()) return {};
    return withoutBlanks(line.substr(columns.begin, columns.end - columns.begin));
  }

  /// @return NaN: the cell is empty, or there is no such title
  double number(std::size_t index, const Columns& columns) const {
    const std::string_view text = cell(index, columns);
    if (text.empty()) return kEmptyCell;
    const std::optional<double> value = numberIn(text);
    if (!value) fail(index, columns.begin, fmt::format("{} is '{}', not a number", columns.name, text));
    return *value;
  }

  std::string file_;
  std::vector<std::string> lines_;
};

class WyomingCsv : public SoundingArchive {
 public:
  explicit WyomingCsv(const std::string& file) : file_(file), text_(soundingText(file)) {
    document::CsvReader reader(text_);
    document::CsvRow row;
    std::array<std::optional<std::size_t>, kColumns> at;
    while (reader.next(row)) {
      const bool is_header =
          std::any_of(row.cells.begin(), row.cells.end(),
                      [](const document::CsvCell& cell) { return cell.text == kNames[kPressure]; });
      if (is_header) {
        for (std::size_t i = 0; i < kColumns; ++i) {
          const auto found =
              std::find_if(row.cells.begin(), row.cells.end(),
                           [&](const document::CsvCell& cell) { return cell.text == kNames[i]; });
          if (found != row.cells.end()) at[i] = static_cast<std::size_t>(found - row.cells.begin());
        }
        header_ = row.line;
        continue;
      }
      if (at[kPressure] && row.cells.size() > 1) read(row, at);
    }
    if (rows_.empty()) throw Error(ErrorCode::bad_input, {file_, header_, 1}, "no rows of a sounding");
  }

  std::vector<SoundingRecord> records() const override {
    SoundingRecord record;
    record.line = header_;
    record.levels = rows_.size();
    record.time_utc = time_;
    std::replace(record.time_utc.begin(), record.time_utc.end(), ' ', 'T');
    record.time_utc += 'Z';
    const std::optional<std::int64_t> time_ms = parseUtc_ms(record.time_utc);
    if (!time_ms) {
      throw Error(ErrorCode::bad_input, {file_, rows_.front().line, 1},
                  fmt::format("time '{}': expected one such as 2024-01-01 12:02:03", time_));
    }
    record.time_ms = *time_ms;
    record.position = position_;
    record.station = position_ ? fmt::format("latitude {:.2f}, longitude {:.2f}", position_->latitude_deg,
                                             position_->longitude_deg)
                               : "an unknown place";
    return {record};
  }

  std::vector<SoundingLevel> levelsOf(const SoundingRecord&) const override { return rows_; }

 private:
  enum Column {
    kTime,
    kLongitude,
    kLatitude,
    kPressure,
    kHeight,
    kTemperature,
    kDewPoint,
    kHumidity,
    kColumns
  };
  static constexpr std::array<const char*, kColumns> kNames{"time",
                                                            "longitude",
                                                            "latitude",
                                                            "pressure_hPa",
                                                            "geopotential height_m",
                                                            "temperature_C",
                                                            "dew point temperature_C",
                                                            "relative humidity_%"};

  void read(const document::CsvRow& row, const std::array<std::optional<std::size_t>, kColumns>& at) {
    const auto numberOf = [&](Column column) {
      if (!at[column] || *at[column] >= row.cells.size()) return kEmptyCell;
      const document::CsvCell& cell = row.cells[*at[column]];
      if (cell.text.empty()) return kEmptyCell;
      const std::optional<double> value = numberIn(cell.text);
      if (value) return *value;
      throw Error(ErrorCode::bad_input, {file_, row.line, cell.column},
                  fmt::format("{} is '{}', not a number", kNames[column], cell.text));
    };
    if (rows_.empty()) {
      if (at[kTime] && *at[kTime] < row.cells.size()) time_ = row.cells[*at[kTime]].text;
      const double latitude_deg = numberOf(kLatitude), longitude_deg = numberOf(kLongitude);
      if (std::abs(latitude_deg) <= 90 && std::abs(longitude_deg) <= 180)
        position_ = GeodeticPosition{latitude_deg, longitude_deg, 0};
    }
    SoundingLevel level;
    level.line = row.line;
    level.pressure_hpa = numberOf(kPressure);
    level.temperature_k = numberOf(kTemperature) + kFreezing_k;
    if (std::isnan(level.pressure_hpa) || std::isnan(level.temperature_k)) return;
    requireAtmosphere(level, file_);
    level.height_msl_m = geometricHeight_m(numberOf(kHeight));
    level.vapour_hpa = vapourOf_hpa(level.temperature_k, numberOf(kDewPoint), numberOf(kHumidity));
    rows_.push_back(level);
  }

  std::string file_, text_, time_;
  int header_ = 1;
  std::optional<GeodeticPosition> position_;
  std::vector<SoundingLevel> rows_;
};

}  // namespace

std::unique_ptr<SoundingArchive> openWyomingList(const std::string& file) {
  return std::make_unique<WyomingList>(file);
}

std::unique_ptr<SoundingArchive> openWyomingCsv(const std::string& file) {
  return std::make_unique<WyomingCsv>(file);
}

}  // namespace emscape::scenario
