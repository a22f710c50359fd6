// Soundings of the Storm Prediction Center, as SHARPpy reads and writes them.
#include <fmt/core.h>

#include <array>
#include <cmath>

#include "base/text/utc.h"
#include "document/csv.h"
#include "document/text_lines.h"
#include "propagation/air/moist_air.h"
#include "scenario/air/sounding.h"

namespace emscape::scenario {
namespace {

/// Sections %TITLE%, whose line is "OAX   140616/1900", and %RAW% of rows LEVEL, HGHT, TEMP, DWPT, WDIR, WSPD
/// (hPa, m, deg C) separated by commas, up to %END%.
class SpcList : public SoundingArchive {
 public:
  explicit SpcList(const std::string& file)
      : file_(file), text_(soundingText(file)), lines_(soundingLines(text_)) {}

  std::vector<SoundingRecord> records() const override {
    std::vector<SoundingRecord> records;
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const std::string_view line = document::withoutBlanks(lines_[i]);
      if (line == "%TITLE%") {
        records.push_back(recordAt(i + 1));
      } else if (line == "%RAW%" && !records.empty() && records.back().first == 0) {
        SoundingRecord& record = records.back();
        record.first = i + 1;
        for (i = record.first; i < lines_.size() && lines_[i].find('%') == std::string_view::npos; ++i) {
        }
        record.levels = i - record.first;
        --i;
      }
    }
    return records;
  }

  std::vector<SoundingLevel> levelsOf(const SoundingRecord& record) const override {
    std::vector<SoundingLevel> levels;
    for (std::size_t i = record.first; i < record.first + record.levels; ++i) {
      if (document::withoutBlanks(lines_[i]).empty()) continue;
      SoundingLevel level;
      level.line = static_cast<int>(i) + 1;
      const auto [pressure_hpa, height_m, temperature_c, dew_point_c] = valuesAt(i);
      level.pressure_hpa = pressure_hpa;
      level.temperature_k = temperature_c + propagation::kFreezing_k;
      if (std::isnan(level.pressure_hpa) || std::isnan(level.temperature_k)) continue;
      requireAtmosphere(level, file_);
      level.height_msl_m = geometricHeight_m(height_m);
      level.vapour_hpa = propagation::saturationPressure_hpa(dew_point_c + propagation::kFreezing_k);
      levels.push_back(level);
    }
    return levels;
  }

 private:
  [[noreturn]] void fail(std::size_t index, const std::string& message) const {
    throw Error(ErrorCode::bad_input, {file_, static_cast<int>(index) + 1, 1}, message);
  }

  SoundingRecord recordAt(std::size_t index) const {
    const auto words =
        index < lines_.size() ? document::wordsOf({lines_[index], 1, 1}) : std::vector<document::TextField>{};
    SoundingRecord record;
    record.line = static_cast<int>(index) + 1;
    const std::string time = words.size() < 2 ? "" : std::string(words[1].text);
    constexpr std::size_t kTime = 11;  // yymmdd/hhmm
    if (time.size() == kTime && time[6] == '/') {
      record.station = std::string(words[0].text);
      record.time_utc = fmt::format("20{}-{}-{}T{}:{}:00Z", time.substr(0, 2), time.substr(2, 2),
                                    time.substr(4, 2), time.substr(7, 2), time.substr(9, 2));
      if (const auto time_ms = parseUtc_ms(record.time_utc)) {
        record.time_ms = *time_ms;
        return record;
      }
    }
    fail(index, "expected a station and a time below %TITLE%, such as OAX 140616/1900");
  }

  /// The first four values of a row; NaN for -9999.
  std::array<double, 4> valuesAt(std::size_t index) const {
    std::array<double, 4> values{};
    document::CsvReader reader(lines_[index]);
    document::CsvRow row;
    if (!reader.next(row) || row.cells.size() < values.size())
      fail(index, "expected LEVEL, HGHT, TEMP, DWPT, WDIR, WSPD, separated by commas");
    for (std::size_t i = 0; i < values.size(); ++i) {
      const std::optional<double> value = document::numberIn(row.cells[i].text);
      if (!value) fail(index, fmt::format("'{}' is not a number", row.cells[i].text));
      constexpr double kUnmeasured = -9999;
      values[i] = *value == kUnmeasured ? std::nan("") : *value;
    }
    return values;
  }

  const std::string file_, text_;
  const std::vector<std::string_view> lines_;
};

}  // namespace

std::unique_ptr<SoundingArchive> openSpc(const std::string& file) {
  return std::make_unique<SpcList>(file);
}

}  // namespace emscape::scenario
