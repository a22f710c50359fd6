// Soundings of the Integrated Global Radiosonde Archive, version 2.
#include <fmt/core.h>

#include <cmath>

#include "base/text/utc.h"
#include "document/text_lines.h"
#include "propagation/air/moist_air.h"
#include "scenario/air/sounding.h"

namespace emscape::scenario {
namespace {

using namespace propagation;
using document::numberIn;

constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// A field by its columns, counted from 1 as in the format's description.
struct FieldSpec {
  const char* name;
  std::size_t first, last;
};
constexpr FieldSpec kYearField{"YEAR", 14, 17}, kMonthField{"MONTH", 19, 20}, kDayField{"DAY", 22, 23},
    kHourField{"HOUR", 25, 26}, kReleaseField{"RELTIME", 28, 31}, kLevelsField{"NUMLEV", 33, 36},
    kLatitudeField{"LAT", 56, 62}, kLongitudeField{"LON", 64, 71};
constexpr FieldSpec kPressureField{"PRESS", 10, 15}, kHeightField{"GPH", 17, 21},
    kTemperatureField{"TEMP", 23, 27}, kHumidityField{"RH", 29, 33}, kDepressionField{"DPDP", 35, 39};

class Igra : public SoundingArchive {
 public:
  explicit Igra(const std::string& file)
      : file_(file), text_(soundingText(file)), lines_(soundingLines(text_)) {}

  std::vector<SoundingRecord> records() const override {
    std::vector<SoundingRecord> records;
    std::size_t without_time = 0;
    for (std::size_t i = 0; i < lines_.size();) {
      const SoundingRecord record = recordAt(i);
      i = record.first + record.levels;
      if (record.time_utc.empty()) {
        ++without_time;
      } else {
        records.push_back(record);
      }
    }
    if (records.empty() && without_time > 0) {
      fail(0, kHourField.first,
           fmt::format("HOUR is 99 and RELTIME 9999 in all soundings, {}: their times are not known",
                       without_time));
    }
    return records;
  }

  std::vector<SoundingLevel> levelsOf(const SoundingRecord& record) const override {
    std::vector<SoundingLevel> levels;
    for (std::size_t i = record.first; i < record.first + record.levels; ++i) {
      SoundingLevel level;
      level.line = static_cast<int>(i) + 1;
      level.pressure_hpa = number(i, kPressureField) / 100;
      level.temperature_k = number(i, kTemperatureField) / 10 + kFreezing_k;
      const double percent = number(i, kHumidityField) / 10, depression_k = number(i, kDepressionField) / 10;
      level.height_msl_m = geometricHeight_m(number(i, kHeightField));
      if (std::isnan(level.pressure_hpa) || std::isnan(level.temperature_k)) continue;
      requireAtmosphere(level, file_);
      if (!std::isnan(percent)) {
        level.vapour_hpa = percent / 100 * saturationPressure_hpa(level.temperature_k);
      } else if (!std::isnan(depression_k)) {
        level.vapour_hpa = saturationPressure_hpa(level.temperature_k - depression_k);
      }
      levels.push_back(level);
    }
    return levels;
  }

 private:
  [[noreturn]] void fail(std::size_t index, std::size_t column, const std::string& message) const {
    throw Error(ErrorCode::bad_input, {file_, static_cast<int>(index) + 1, static_cast<int>(column)},
                message);
  }

  std::string_view textOf(std::size_t index, const FieldSpec& field) const {
    return lines_[index].substr(field.first - 1, field.last - field.first + 1);
  }

  /// @return NaN: missing (-9999) or removed by the archive's checks (-8888)
  double number(std::size_t index, const FieldSpec& field) const {
    const std::string_view line = lines_[index];
    if (line.size() < field.last) {
      fail(index, line.size() + 1,
           fmt::format("the line ends before {} in columns {} to {}", field.name, field.first, field.last));
    }
    const std::string_view text = textOf(index, field);
    const std::optional<double> value =
        numberIn(text.substr(std::min(text.find_first_not_of(' '), text.size())));
    if (!value) fail(index, field.first, fmt::format("{} is '{}', not a number", field.name, text));
    return *value == -9999 || *value == -8888 ? kMissing : *value;
  }

  static constexpr int kUnknown = 99;  ///< an hour, or minutes

  /// @throws Error (bad_input) for a value that is missing, not whole, or outside [lowest, highest]
  int wholeNumber(std::size_t index, const FieldSpec& field, int lowest, int highest) const {
    const double value = number(index, field);
    if (!(value >= lowest && value <= highest) || value != std::floor(value)) {
      fail(index, field.first,
           fmt::format("{} is '{}', not a whole number from {} to {}", field.name, textOf(index, field),
                       lowest, highest));
    }
    return static_cast<int>(value);
  }

  /// Without a time if neither the hour nor the time of release is known.
  SoundingRecord recordAt(std::size_t index) const {
    const std::string_view line = lines_[index];
    if (line.empty() || line.front() != '#') {
      fail(index, 1,
           "a sounding's header begins with #; NUMLEV of the header before is not its number of levels");
    }
    SoundingRecord record;
    record.line = static_cast<int>(index) + 1;
    record.first = index + 1;
    record.levels = static_cast<std::size_t>(wholeNumber(index, kLevelsField, 0, 9999));
    if (record.first + record.levels > lines_.size()) {
      fail(
          index, kLevelsField.first,
          fmt::format("NUMLEV is {}, but only {} lines follow", record.levels, lines_.size() - record.first));
    }
    record.station = line.substr(1, 11);
    // Where the nominal hour is missing, 99, the time of release stands for it: 9999 if it is missing, too,
    // HH99 without minutes.
    int hour = wholeNumber(index, kHourField, 0, 99), minute = 0;
    if (hour == kUnknown) {
      const int release = wholeNumber(index, kReleaseField, 0, 9999);
      hour = release / 100;
      minute = release % 100 == kUnknown ? 0 : release % 100;
    }
    if (hour == kUnknown) return record;
    record.time_utc = fmt::format(
        "{:04}-{:02}-{:02}T{:02}:{:02}:00Z", wholeNumber(index, kYearField, 0, 9999),
        wholeNumber(index, kMonthField, 0, 99), wholeNumber(index, kDayField, 0, 99), hour, minute);
    const std::optional<std::int64_t> time_ms = parseUtc_ms(record.time_utc);
    if (!time_ms) fail(index, kYearField.first, fmt::format("{} is not a time", record.time_utc));
    record.time_ms = *time_ms;
    if (line.size() >= kLongitudeField.last) {
      // 1e-4 degrees; -998.8888 and -999.9999: the station moves, or its place is not known.
      const double latitude_deg = number(index, kLatitudeField) / 1e4,
                   longitude_deg = number(index, kLongitudeField) / 1e4;
      if (std::abs(latitude_deg) <= 90 && std::abs(longitude_deg) <= 180)
        record.position = GeodeticPosition{latitude_deg, longitude_deg, 0};
    }
    return record;
  }

  std::string file_, text_;
  std::vector<std::string_view> lines_;
};

}  // namespace

std::unique_ptr<SoundingArchive> openIgra(const std::string& file) {
  return std::make_unique<Igra>(file);
}

}  // namespace emscape::scenario
