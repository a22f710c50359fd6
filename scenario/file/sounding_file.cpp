// Soundings of the Integrated Global Radiosonde Archive, version 2 (IGRA 2): fixed columns, according to
// NOAA's "IGRA v2 Format Description: Sounding Data".
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string_view>

#include "base/files/file_reading.h"
#include "base/text/utc.h"
#include "emscape/base/error.h"
#include "propagation/air/moist_air.h"
#include "scenario/antenna/text.h"
#include "scenario/file/refractivity_file.h"

namespace emscape::scenario {
namespace {

using namespace propagation;

constexpr std::size_t kMaxSoundingBytes = std::size_t{64} << 20;
constexpr double kHighest_m = 10000;
constexpr double kMinStep_m = 1;    ///< between levels
constexpr double kTolerance = 0.5;  ///< M-units
constexpr std::size_t kMaxLevels = 256;
constexpr double kGravity_m_s2 = 9.80665, kDryGas_j_kg_k = 287.05;
constexpr double kGeopotentialRadius_m = 6356766;
constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

/// A field by its columns, counted from 1 as in the format's description.
struct FieldSpec {
  const char* name;
  std::size_t first, last;
};
constexpr FieldSpec kYearField{"YEAR", 14, 17}, kMonthField{"MONTH", 19, 20}, kDayField{"DAY", 22, 23},
    kHourField{"HOUR", 25, 26}, kLevelsField{"NUMLEV", 33, 36};
constexpr FieldSpec kPressureField{"PRESS", 10, 15}, kHeightField{"GPH", 17, 21},
    kTemperatureField{"TEMP", 23, 27}, kHumidityField{"RH", 29, 33}, kDepressionField{"DPDP", 35, 39};

struct Line {
  std::string_view text;
  int number = 0;
};

struct Header {
  Line line;
  std::size_t first = 0;  ///< line of its first level, as an index
  int levels = 0;
  std::string station, time_utc;
  std::int64_t time_ms = 0;
};

/// A level with pressure and temperature.
struct Level {
  int line = 0;
  double pressure_hpa = 0, temperature_k = 0;
  double vapour_hpa = kMissing, height_msl_m = kMissing;
};

class SoundingReader {
 public:
  explicit SoundingReader(const std::string& file)
      : file_(file), text_(readWholeText(file, kMaxSoundingBytes)) {
    int number = 0;
    for (std::size_t begin = 0; begin < text_.size();) {
      const std::size_t end = std::min(text_.find('\n', begin), text_.size());
      std::string_view line(text_.data() + begin, end - begin);
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      lines_.push_back({line, ++number});
      begin = end + 1;
    }
  }

  RefractivityFile read(std::optional<std::int64_t> time_ms) {
    Header chosen;
    int count = 0;
    for (std::size_t i = 0; i < lines_.size();) {
      const Header header = headerAt(i);
      const auto distance = [&](const Header& h) { return std::llabs(h.time_ms - *time_ms); };
      if (count++ == 0 || !time_ms || distance(header) < distance(chosen)) chosen = header;
      i = header.first + std::size_t(header.levels);
    }
    if (count == 0) throw Error(ErrorCode::bad_input, {file_, 1, 1}, "no soundings; a header begins with #");
    std::vector<Level> levels = levelsOf(chosen);
    completeHumidity(levels);
    completeHeights(chosen, levels);
    RefractivityFile result;
    result.field.profiles = {profileOf(chosen, levels)};
    result.description = fmt::format("sounding of {}, {} ({} of {} levels; {} soundings in the file)",
                                     chosen.station, chosen.time_utc, levels.size(), chosen.levels, count);
    return result;
  }

 private:
  [[noreturn]] void fail(const Line& line, std::size_t column, const std::string& message) const {
    throw Error(ErrorCode::bad_input, {file_, line.number, int(column)}, message);
  }

  /// @return NaN: missing (-9999) or removed by the archive's checks (-8888)
  double number(const Line& line, const FieldSpec& field) const {
    if (line.text.size() < field.last) {
      fail(line, line.text.size() + 1,
           fmt::format("the line ends before {} in columns {} to {}", field.name, field.first, field.last));
    }
    std::string_view text = line.text.substr(field.first - 1, field.last - field.first + 1);
    const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
    const std::optional<double> value = numberIn(text.substr(begin));
    if (!value) fail(line, field.first, fmt::format("{} is '{}', not a number", field.name, text));
    return *value == -9999 || *value == -8888 ? kMissing : *value;
  }

  /// @throws Error (bad_input) for a value that is missing, not whole, or outside [lowest, highest]
  int wholeNumber(const Line& line, const FieldSpec& field, int lowest, int highest) const {
    const double value = number(line, field);
    if (!(value >= lowest && value <= highest) || value != std::floor(value)) {
      fail(line, field.first,
           fmt::format("{} is '{}', not a whole number from {} to {}", field.name,
                       line.text.substr(field.first - 1, field.last - field.first + 1), lowest, highest));
    }
    return int(value);
  }

  Header headerAt(std::size_t index) const {
    const Line& line = lines_[index];
    if (line.text.empty() || line.text.front() != '#') {
      fail(line, 1,
           "a sounding's header begins with #; NUMLEV of the header before is not its number of levels");
    }
    Header header;
    header.line = line;
    header.first = index + 1;
    header.levels = wholeNumber(line, kLevelsField, 0, 9999);
    if (header.first + std::size_t(header.levels) > lines_.size()) {
      fail(
          line, kLevelsField.first,
          fmt::format("NUMLEV is {}, but only {} lines follow", header.levels, lines_.size() - header.first));
    }
    const int hour = wholeNumber(line, kHourField, 0, 99);  // 99: missing
    header.station = line.text.substr(1, 11);
    header.time_utc = fmt::format("{:04}-{:02}-{:02}T{:02}:00:00Z", wholeNumber(line, kYearField, 0, 9999),
                                  wholeNumber(line, kMonthField, 0, 99), wholeNumber(line, kDayField, 0, 99),
                                  hour == 99 ? 0 : hour);
    const std::optional<std::int64_t> time_ms = parseUtc_ms(header.time_utc);
    if (!time_ms) fail(line, kYearField.first, fmt::format("{} is not a time", header.time_utc));
    header.time_ms = *time_ms;
    return header;
  }

  std::vector<Level> levelsOf(const Header& header) const {
    std::vector<Level> levels;
    for (int i = 0; i < header.levels; ++i) {
      const Line& line = lines_[header.first + std::size_t(i)];
      Level level;
      level.line = line.number;
      level.pressure_hpa = number(line, kPressureField) / 100;
      level.temperature_k = number(line, kTemperatureField) / 10 + kFreezing_k;
      const double height_m = number(line, kHeightField), percent = number(line, kHumidityField) / 10,
                   depression_k = number(line, kDepressionField) / 10;
      // Geopotential to geometric height.
      level.height_msl_m = height_m * kGeopotentialRadius_m / (kGeopotentialRadius_m - height_m);
      if (std::isnan(level.pressure_hpa) || std::isnan(level.temperature_k)) continue;
      if (level.temperature_k < 150 || level.temperature_k > 350 || level.pressure_hpa <= 0 ||
          level.pressure_hpa > 1100) {
        fail(line, kPressureField.first,
             fmt::format("{} hPa and {} K are not of the atmosphere", level.pressure_hpa,
                         level.temperature_k));
      }
      if (!std::isnan(percent)) {
        level.vapour_hpa = percent / 100 * saturationPressure_hpa(level.temperature_k);
      } else if (!std::isnan(depression_k)) {
        level.vapour_hpa = saturationPressure_hpa(level.temperature_k - depression_k);
      }
      levels.push_back(level);
    }
    return levels;
  }

  static void completeHumidity(std::vector<Level>& levels) {
    std::size_t known = levels.size();
    while (known > 0 && std::isnan(levels[known - 1].vapour_hpa)) --known;
    std::vector<Level> kept;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      if (i >= known && known > 0) levels[i].vapour_hpa = 0;
      if (!std::isnan(levels[i].vapour_hpa)) kept.push_back(levels[i]);
    }
    levels = std::move(kept);
  }

  void completeHeights(const Header& header, std::vector<Level>& levels) const {
    const auto thickness_m = [](const Level& lower, const Level& upper) {
      const auto virtual_k = [](const Level& level) {
        return level.temperature_k / (1 - 0.37802 * level.vapour_hpa / level.pressure_hpa);
      };
      return kDryGas_j_kg_k / kGravity_m_s2 * (virtual_k(lower) + virtual_k(upper)) / 2 *
             std::log(lower.pressure_hpa / upper.pressure_hpa);
    };
    std::size_t known = 0;
    while (known < levels.size() && std::isnan(levels[known].height_msl_m)) ++known;
    if (known == levels.size()) {
      fail(header.line, 1,
           levels.empty() ? "the sounding has no level with pressure, temperature and humidity"
                          : "the sounding has no level with pressure, temperature, humidity and GPH");
    }
    for (std::size_t i = known; i > 0; --i) {
      levels[i - 1].height_msl_m = levels[i].height_msl_m - thickness_m(levels[i - 1], levels[i]);
    }
    for (std::size_t i = known + 1; i < levels.size(); ++i) {
      if (std::isnan(levels[i].height_msl_m)) {
        levels[i].height_msl_m = levels[i - 1].height_msl_m + thickness_m(levels[i - 1], levels[i]);
      }
    }
  }

  RefractivityProfile profileOf(const Header& header, const std::vector<Level>& levels) const {
    std::vector<RefractivityLevel> all;
    for (const Level& level : levels) {
      if (level.height_msl_m > kHighest_m) break;
      if (!all.empty() && level.height_msl_m < all.back().height_msl_m + kMinStep_m) continue;
      all.push_back(
          {level.height_msl_m, refractivity_n(level.pressure_hpa, level.temperature_k, level.vapour_hpa) +
                                   kFlatteningGradient_m * level.height_msl_m});
      if (const std::string fault = faultOfLevel(all, all.size() - 1); !fault.empty()) {
        fail(lines_[std::size_t(level.line) - 1], kPressureField.first, fault);
      }
    }
    if (all.size() < 2) {
      fail(header.line, 1,
           fmt::format(
               "the sounding has {} levels with pressure, temperature and humidity; expected 2 or more",
               all.size()));
    }
    std::vector<RefractivityLevel> few = thinned(all, kTolerance);
    for (double tolerance = 2 * kTolerance; few.size() > kMaxLevels; tolerance *= 2)
      few = thinned(all, tolerance);
    return profileOfLevels(std::move(few));
  }

  std::string file_, text_;
  std::vector<Line> lines_;
};

}  // namespace

RefractivityFile readSounding(const std::string& file, std::optional<std::int64_t> time_ms) {
  return SoundingReader(file).read(time_ms);
}

bool isSoundingFile(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string line(kLevelsField.last, '\0');
  stream.read(line.data(), std::streamsize(line.size()));
  line.resize(std::size_t(stream.gcount()));
  return line.size() >= kLevelsField.last && line.front() == '#' && line[12] == ' ' && line[17] == ' ' &&
         numberIn(std::string_view(line).substr(kYearField.first - 1, 4)).has_value();
}

}  // namespace emscape::scenario
