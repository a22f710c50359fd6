#include "scenario/air/refractivity_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/files/file_reading.h"
#include "document/csv.h"
#include "document/text_file.h"
#include "document/text_lines.h"
#include "emscape/base/error.h"
#include "propagation/air/moist_air.h"
#include "scenario/air/sounding.h"
#include "scenario/terrain/file_names.h"

namespace emscape::scenario {
namespace {

using namespace propagation;
using document::CsvCell;
using document::CsvRow;
using document::numberIn;
using Position = RefractivityField::Position;

constexpr const char* kHeader =
    "height_msl_m and m_units, or n_units, or pressure_hpa, temperature_k and relative_humidity_percent; for "
    "several profiles range_m, or latitude_deg and longitude_deg";
constexpr double kAny = std::numeric_limits<double>::max();
constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

enum Column { range, latitude, longitude, height, m, n, pressure, temperature, humidity, kColumns };
struct ColumnLimits {
  const char* name;
  double lowest, highest;
  const char* below;  ///< probable meaning of a value outside
  const char* above;
};
constexpr std::array<ColumnLimits, kColumns> kLimits{{
    {"range_m", 0, 1e7, "", ""},
    {"latitude_deg", -90, 90, "", ""},
    {"longitude_deg", -180, 180, "", ""},
    {"height_msl_m", -kAny, kAny, "", ""},
    {"m_units", -kAny, kAny, "", ""},
    {"n_units", 0, 500, "", "; is it M?"},
    {"pressure_hpa", 0.1, 1100, "", "; is it in Pa?"},
    {"temperature_k", 150, 350, "; is it in degrees Celsius?", ""},
    {"relative_humidity_percent", 0, 100, "", ""},
}};

/// A file whose humidities (percent) are all as low probably has them as fractions of 1.
constexpr double kLikelyFraction = 1.5;

/// True if M falls over the last 500 m of a profile of more than 1 km, as N does.
bool looksLikeN(const RefractivityProfile& profile) {
  const double top_m = profile.levels.back().height_msl_m;
  return top_m - profile.levels.front().height_msl_m > 1000 && profile.at(top_m) < profile.at(top_m - 500);
}

/// Told of a profile whose N at its top is none of the air's at that height, within a third of the reference
/// atmosphere of ITU-R P.453 (315 exp(-h / 7.35 km)), which holds dry and tropical air; empty: it is one.
std::string strangeTopText(const RefractivityProfile& profile) {
  constexpr double kLowest_m = 300, kHighest_m = 10000, kLow = 0.65, kHigh = 1.35;
  const double top_m = std::min(profile.levels.back().height_msl_m, kHighest_m);
  if (top_m - profile.levels.front().height_msl_m < kLowest_m) return "";
  const double n_units = profile.at(top_m) - kFlatteningGradient_m * top_m;
  const double usual_n_units = 315 * std::exp(-top_m / 7350);
  if (n_units >= kLow * usual_n_units && n_units <= kHigh * usual_n_units) return "";
  return fmt::format(
      "its air has {:.0f} N-units at {:.0f} m, usual are about {:.0f}: are the heights in feet?", n_units,
      top_m, usual_n_units);
}

class CsvProfiles {
 public:
  explicit CsvProfiles(const std::string& file)
      : file_(file), text_(document::checkedUtf8(file, readWholeText(file, kMaxBytes))), reader_(text_) {}

  RefractivityFile read() {
    readHeader();
    while (reader_.next(row_)) readRow();
    if (levels_.empty()) throw Error(ErrorCode::bad_input, {file_, reader_.lines(), 0}, kFewLevels);
    finishProfile();
    RefractivityFile result;
    RefractivityField& field = result.field;
    field.profiles.clear();
    std::string thinning;
    for (const std::vector<RefractivityLevel>& levels : levels_) {
      const bool is_too_long = levels.size() > kMaxProfileLevels;
      ThinnedLevels few = is_too_long ? thinnedToLimit(levels) : ThinnedLevels{levels, levels.size(), 0};
      if (thinning.empty()) thinning = few.text();
      field.profiles.push_back(profileOfLevels(std::move(few.levels)));
    }
    if (has(range)) field.ranges_m = ranges_m_;
    if (has(latitude)) field.positions = positions_;
    const std::size_t count = field.profiles.size();
    result.description = count == 1   ? "1 profile"
                         : has(range) ? fmt::format("{} profiles by range", count)
                                      : fmt::format("{} profiles by place", count);
    result.description += thinning;
    if (std::string unended = reader_.unendedWarning(file_, "a level"); !unended.empty())
      result.warnings.push_back(std::move(unended));
    if (has(m) && std::any_of(field.profiles.begin(), field.profiles.end(), looksLikeN)) {
      result.warnings.push_back(fmt::format(
          "{}: m_units falls with height at the top: these look like N-units (column n_units)", file_));
    } else if (const std::string strange = strangeTopText(field.profiles.front()); !strange.empty()) {
      result.warnings.push_back(fmt::format("{}: {}", file_, strange));
    }
    if (has(humidity) && highest_humidity_ > 0 && highest_humidity_ <= kLikelyFraction) {
      result.warnings.push_back(
          fmt::format("{}: {} is {:g} at most: is it a fraction? It is taken as percent", file_,
                      kLimits[humidity].name, highest_humidity_));
    }
    if (std::any_of(field.profiles.begin(), field.profiles.end(), [&](const RefractivityProfile& profile) {
          return profile.levels.size() != field.profiles.front().levels.size();
        })) {
      result.warnings.push_back(
          fmt::format("{}: profiles differ in their numbers of levels: interpolated at each height, which "
                      "shows two faint ducts halfway between two",
                      file_));
    }
    return result;
  }

 private:
  static constexpr const char* kFewLevels = "no levels; expected 2 or more";

  bool has(Column column) const { return position_[column].has_value(); }

  [[noreturn]] void fail(const CsvCell& cell, const std::string& message) const {
    throw Error(ErrorCode::bad_input, {file_, row_.line, cell.column}, message);
  }

  void readHeader() {
    if (!reader_.next(row_)) {
      throw Error(ErrorCode::bad_input, {file_, 1, 1},
                  fmt::format("the file is empty; its header has {}", kHeader));
    }
    if (const auto fault = document::headerFault(row_.cells))
      throw Error(ErrorCode::bad_input, {file_, row_.line, fault->column}, fault->message);
    columns_ = row_.cells.size();
    for (std::size_t i = 0; i < columns_; ++i) {
      const CsvCell& cell = row_.cells[i];
      const auto column = std::find_if(kLimits.begin(), kLimits.end(),
                                       [&](const ColumnLimits& limits) { return cell.text == limits.name; });
      if (column == kLimits.end()) {
        fail(cell, fmt::format("unknown column '{}'; the header has {}", cell.text, kHeader));
      }
      std::optional<std::size_t>& position = position_[std::size_t(column - kLimits.begin())];
      if (position) fail(cell, fmt::format("second column '{}'; the header has {}", cell.text, kHeader));
      position = i;
    }
    const bool is_weather = has(pressure) && has(temperature) && has(humidity);
    const bool has_weather = has(pressure) || has(temperature) || has(humidity);
    const bool is_complete = has(height) && int(has(m)) + int(has(n)) + int(has_weather) == 1 &&
                             is_weather == has_weather && has(latitude) == has(longitude) &&
                             !(has(range) && has(latitude));
    if (!is_complete) {
      throw Error(ErrorCode::bad_input, {file_, row_.line, 1}, fmt::format("the header has {}", kHeader));
    }
  }

  const CsvCell& cell(Column column) const { return row_.cells[*position_[column]]; }

  double number(Column column) const {
    const ColumnLimits& limits = kLimits[column];
    const std::optional<double> value = numberIn(cell(column).text);
    if (!value) fail(cell(column), fmt::format("{} is '{}', not a number", limits.name, cell(column).text));
    if (*value >= limits.lowest && *value <= limits.highest) return *value;
    constexpr double kFill = -999;  // and lower
    fail(cell(column),
         fmt::format("{} is {}; allowed are {} to {}{}", limits.name, *value, limits.lowest, limits.highest,
                     *value <= kFill          ? "; is it a missing value? Leave its row out"
                     : *value < limits.lowest ? limits.below
                                              : limits.above));
  }

  void readRow() {
    if (row_.cells.size() != columns_) {
      fail(row_.cells.front(),
           fmt::format("{} values, but the header names {} columns", row_.cells.size(), columns_));
    }
    beginProfile();
    RefractivityLevel level;
    level.height_msl_m = number(height);
    level.m_units =
        has(m) ? number(m) : kFlatteningGradient_m * level.height_msl_m + (has(n) ? number(n) : nOfWeather());
    levels_.back().push_back(level);
    if (const std::string fault = faultOfLevel(levels_.back(), levels_.back().size() - 1); !fault.empty()) {
      const std::string contradiction = contradictionOfThickness(weather_);
      fail(cell(height), contradiction.empty() ? fault : fault + "; " + contradiction);
    }
  }

  double nOfWeather() {
    const double temperature_k = number(temperature), humidity_percent = number(humidity);
    highest_humidity_ = std::max(highest_humidity_, humidity_percent);
    const double vapour_hpa = humidity_percent / 100 * saturationPressure_hpa(temperature_k);
    weather_.push_back({row_.line, number(pressure), temperature_k, vapour_hpa, number(height)});
    return refractivity_n(number(pressure), temperature_k, vapour_hpa);
  }

  /// Begins a profile if range or position of the row differ from those of the previous row.
  void beginProfile() {
    const double range_m = has(range) ? number(range) : 0;
    const Position position = has(latitude) ? Position{number(latitude), number(longitude)} : Position{};
    const auto isHere = [&](const Position& other) {
      return other.latitude_deg == position.latitude_deg && other.longitude_deg == position.longitude_deg;
    };
    if (!levels_.empty() && range_m == ranges_m_.back() && isHere(positions_.back())) return;
    finishProfile();
    if (!levels_.empty() && range_m < ranges_m_.back()) {
      fail(cell(range), fmt::format("range_m is {} behind {}; ranges ascend", range_m, ranges_m_.back()));
    }
    if (has(latitude) && std::any_of(positions_.begin(), positions_.end(), isHere)) {
      fail(cell(latitude), fmt::format("the rows of the place {}, {} do not follow each other",
                                       position.latitude_deg, position.longitude_deg));
    }
    ranges_m_.push_back(range_m);
    positions_.push_back(position);
    levels_.emplace_back();
  }

  void finishProfile() {
    const std::string contradiction = contradictionOfThickness(weather_);
    if (!contradiction.empty())
      throw Error(ErrorCode::bad_input, {file_, weather_.front().line, 0}, contradiction);
    weather_.clear();
    if (levels_.empty() || levels_.back().size() >= 2) return;
    throw Error(ErrorCode::bad_input, {file_, row_.line, 0},
                "the profile that ends here has 1 level; expected 2 or more");
  }

  std::string file_, text_;
  document::CsvReader reader_;
  CsvRow row_;
  std::size_t columns_ = 0;
  double highest_humidity_ = 0;
  std::array<std::optional<std::size_t>, kColumns> position_;
  std::vector<double> ranges_m_;
  std::vector<Position> positions_;
  std::vector<std::vector<RefractivityLevel>> levels_;
  std::vector<SoundingLevel> weather_;  ///< of the last profile
};

}  // namespace

std::string ThinnedLevels::text() const {
  if (levels.size() == count_before) return "";
  return fmt::format(", thinned from {} to {} within {:g} M-units", count_before, levels.size(), tolerance);
}

ThinnedLevels thinnedToLimit(const std::vector<RefractivityLevel>& levels) {
  ThinnedLevels result{{}, levels.size(), 0.25};
  do {
    result.tolerance *= 2;
    result.levels = thinned(levels, result.tolerance);
  } while (result.levels.size() > kMaxProfileLevels);
  return result;
}

RefractivityFile readRefractivity(const std::string& file) {
  if (const std::string packed = packedFileText(file); !packed.empty())
    throw Error(ErrorCode::bad_input, {file, 0, 0}, "a profile is read from a .csv: " + packed);
  return CsvProfiles(file).read();
}

bool isRefractivityCsv(const std::string& file) {
  const std::vector<std::string> names = document::csvColumnsOf(file);
  const auto has = [&](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  const auto hasColumn = [&](Column column) { return has(kLimits[column].name); };
  const bool is_track = has("t_s");
  return hasColumn(m) || hasColumn(n) || hasColumn(humidity) || (hasColumn(height) && !is_track);
}

bool isTableOfAir(const std::string& file) {
  const std::vector<std::string> names = document::csvColumnsOf(file);
  const auto has = [&](const char* word) {
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return document::upperCase(name).find(word) != std::string::npos;
    });
  };
  return has("TEMP") && (has("PRES") || has("HPA"));
}

const char* refractivityColumns() {
  return kHeader;
}

}  // namespace emscape::scenario
