#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "recording/common/dates.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"
#include "recording/common/track_recorder.h"
#include "recording/tracks/track_formats.h"

namespace emscape::interop {
namespace {

constexpr double kDay_s = 86400;

/// "hhmmss.ss" as seconds of the day.
std::optional<double> timeOf(std::string_view text) {
  const auto value = text.size() >= 6 ? numberIn(text) : std::nullopt;
  if (!value || *value < 0 || *value >= 240000) return std::nullopt;
  const double hours = std::floor(*value / 10000), minutes = std::floor(std::fmod(*value, 10000) / 100);
  if (minutes > 59) return std::nullopt;
  return hours * 3600 + minutes * 60 + std::fmod(*value, 100);
}

/// "ddmm.mmm" and N, S, E or W in degrees.
std::optional<double> angleOf(std::string_view text, std::string_view hemisphere) {
  const auto value = numberIn(text);
  if (!value || *value < 0 || hemisphere.size() != 1) return std::nullopt;
  const double degrees = std::floor(*value / 100);
  const double angle_deg = degrees + (*value - degrees * 100) / 60;
  return hemisphere == "S" || hemisphere == "W" ? -angle_deg : angle_deg;
}

/// The fields of a sentence; empty if its checksum is wrong. The first one has the talker, too.
std::vector<std::string_view> fieldsOf(std::string_view sentence) {
  const std::size_t star = sentence.find('*');
  if (star != std::string_view::npos) {
    unsigned sum = 0;
    for (const char c : sentence.substr(1, star - 1)) sum ^= static_cast<unsigned char>(c);
    const std::string told(trimmed(sentence.substr(star + 1)));
    if (told != fmt::format("{:02X}", sum) && told != fmt::format("{:02x}", sum)) return {};
  }
  std::string_view rest = sentence.substr(0, star);
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    fields.push_back(rest.substr(0, comma));
    if (comma == rest.size()) return fields;
    rest.remove_prefix(comma + 1);
  }
}

/// The sentences of one time are one fix: RMC has the date, GGA and GNS have the height.
class NmeaReader {
 public:
  NmeaReader(const std::string& name, const ReadOptions& options) : recorder_("NMEA 0183", options) {
    object_ = recorder_.objectOf(std::filesystem::path(name).stem().string());
  }

  Recording read(LineReader& lines) {
    for (std::string_view line; lines.next(line);) {
      line = trimmed(line);
      if (line.empty() || line.front() == '#') continue;
      // Loggers write the time of arrival before it.
      if (const std::size_t begin = line.find_first_of("$!"); begin != line.npos) line.remove_prefix(begin);
      location_ = fmt::format("line {}", lines.line());
      ++recorder_.tally().records;
      if (line.front() == '!') {
        countIgnored(recorder_.tally(), "AIS sentence (decode AIS into a table first)");
        continue;
      }
      const std::vector<std::string_view> fields =
          line.front() == '$' ? fieldsOf(line) : std::vector<std::string_view>();
      if (fields.empty()) {
        countBad(recorder_.tally(), location_, "no sentence of NMEA 0183, or a wrong checksum");
      } else {
        take(fields);
      }
    }
    flush();
    if (has_date_) recorder_.hasUtc(first_date_s_);
    Recording recording = recorder_.finish();
    recording.has_times_of_day = !has_date_;
    return recording;
  }

 private:
  struct Fix {
    double time_s = 0;  ///< of the day
    std::optional<double> latitude_deg, longitude_deg, height_msl_m;
    std::string location;
  };

  void take(const std::vector<std::string_view>& fields) {
    const std::string_view kind = fields[0].substr(std::min<std::size_t>(3, fields[0].size()));
    const auto field = [&](std::size_t i) { return i < fields.size() ? fields[i] : std::string_view(); };
    if (kind == "RMC") {
      if (field(2) != "A") return countIgnored(recorder_.tally(), "fix that is not valid");
      if (!begin(field(1))) return;
      place(field(3), field(4), field(5), field(6));
      takeDate(field(9));
    } else if (kind == "GGA" || kind == "GNS") {
      const bool is_valid =
          kind == "GGA" ? field(6) != "0" : field(6).find_first_not_of('N') != field(6).npos;
      if (!is_valid) return countIgnored(recorder_.tally(), "fix that is not valid");
      if (!begin(field(1))) return;
      place(field(2), field(3), field(4), field(5));
      fix_->height_msl_m = numberIn(field(9));
      if (kind == "GGA" && fix_->height_msl_m) takeUnit(field(10));
    } else if (kind == "ZDA") {
      const auto day = numberIn(field(2)), month = numberIn(field(3)), year = numberIn(field(4));
      if (begin(field(1)) && day && month && year) setDate(*year, *month, *day);
    } else {
      countIgnored(recorder_.tally(), "sentence " + printableText(kind.substr(0, 8)));
    }
  }

  /// Begins a fix, or goes on with that of the same time.
  bool begin(std::string_view time) {
    const auto time_s = timeOf(time);
    if (!time_s) {
      countBad(recorder_.tally(), location_, "its time is not hhmmss");
      return false;
    }
    if (fix_ && fix_->time_s == *time_s) return true;
    flush();
    if (last_s_ && *time_s < *last_s_ - kDay_s / 2) day_s_ += kDay_s;  // midnight
    last_s_ = time_s;
    fix_ = Fix{*time_s, {}, {}, {}, location_};
    return true;
  }

  void place(std::string_view latitude, std::string_view north, std::string_view longitude,
             std::string_view east) {
    const auto latitude_deg = angleOf(latitude, north), longitude_deg = angleOf(longitude, east);
    if (!latitude_deg || !longitude_deg)
      return countBad(recorder_.tally(), location_, "its position is not ddmm.mm,N,dddmm.mm,E");
    constexpr double kApart_deg = 0.001;
    if (fix_->latitude_deg && (std::abs(*fix_->latitude_deg - *latitude_deg) > kApart_deg ||
                               std::abs(*fix_->longitude_deg - *longitude_deg) > kApart_deg))
      recorder_.assume(
          "sentences of one time at two places, as of two receivers in one log: the last is used; grep "
          "'^$GP' "
          "makes a log of one talker");
    fix_->latitude_deg = latitude_deg;
    fix_->longitude_deg = longitude_deg;
  }

  /// Of a height: M by the standard; some receivers write feet.
  void takeUnit(std::string_view unit) {
    constexpr double kMetresPerFoot = 0.3048;
    if (unit == "F" || unit == "f") {
      *fix_->height_msl_m *= kMetresPerFoot;
    } else if (!unit.empty() && unit != "M" && unit != "m") {
      recorder_.assumeHeight(
          fmt::format("height in '{}': taken as metres", printableText(unit.substr(0, 8))));
    }
  }

  void takeDate(std::string_view text) {
    const auto value = text.size() == 6 ? numberIn(text) : std::nullopt;
    if (!value) return;
    const double year = std::fmod(*value, 100);
    setDate(year + (year < 80 ? 2000 : 1900), std::floor(std::fmod(*value, 10000) / 100),
            std::floor(*value / 10000));
  }

  void setDate(double year, double month, double day) {
    const bool is_sound = year >= 1980 && year <= 9999 && month >= 1 && month <= 12 && day >= 1 && day <= 31;
    if (!is_sound) return countBad(recorder_.tally(), location_, "its date is out of range");
    const double date_s =
        secondsOfDate(static_cast<int>(year), static_cast<int>(month), static_cast<int>(day));
    if (!has_date_) first_date_s_ = date_s - day_s_;  // of the fixes before it
    has_date_ = true;
    day_s_ = date_s - first_date_s_;
  }

  void flush() {
    const std::optional<Fix> fix = std::move(fix_);
    fix_.reset();
    if (!fix || !fix->latitude_deg) return;
    PoseSample pose;
    pose.t_s = day_s_ + fix->time_s;
    pose.latitude_deg = *fix->latitude_deg;
    pose.longitude_deg = *fix->longitude_deg;
    pose.height_msl_m = fix->height_msl_m.value_or(kUnknown);
    recorder_.add(object_, pose, fix->location);
  }

  TrackRecorder recorder_;
  std::size_t object_ = 0;
  std::string location_;
  std::optional<Fix> fix_;
  std::optional<double> last_s_;
  double day_s_ = 0, first_date_s_ = 0;
  bool has_date_ = false;
};

}  // namespace

Recording readNmea(ByteSource& source, const std::string& name, const ReadOptions& options) {
  LineReader lines(source);
  return NmeaReader(name, options).read(lines);
}

}  // namespace emscape::interop
