#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <map>

#include "emscape/base/error.h"
#include "emscape/base/geodesy/geo_frame.h"
#include "recording/common/dates.h"
#include "recording/common/tally.h"
#include "recording/common/text.h"
#include "recording/tracks/interpolated_track.h"
#include "recording/tracks/track_formats.h"

namespace emscape::interop {
namespace {

/// How the lines of a section state positions.
enum class Positions { cartesian, geodetic };

class StkReader {
 public:
  StkReader(const std::string& name, const ReadOptions& options)
      : stem_(std::filesystem::path(name).stem().string()), recorder_("STK ephemeris", options) {
    object_ = recorder_.objectOf(stem_);
  }

  Recording read(LineReader& lines) {
    bool has_ended = false;
    for (std::string_view line; !has_ended && lines.next(line);) {
      const std::vector<std::string> words = wordsOf(line, {"#"});
      if (words.empty()) continue;
      location_ = fmt::format("line {}", lines.line());
      const std::string key = lowerCase(words[0]);
      if (key == "end" && words.size() > 1 && lowerCase(words[1]) == "ephemeris") {
        has_ended = true;
      } else if (numberIn(words[0]) && section_) {
        takeSample(words);
      } else {
        takeKey(key, words, line);
      }
    }
    if (!has_ended) recorder_.tally().torn = fmt::format("line {}: END Ephemeris is missing", lines.line());
    if (has_epoch_) recorder_.hasUtc();
    addInterpolated(recorder_, object_, samples_, is_linear_ ? 1 : degree_, stem_);
    return recorder_.finish();
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const {
    throw Error(ErrorCode::bad_input, location_ + ": " + reason);
  }

  void takeKey(const std::string& key, const std::vector<std::string>& words, std::string_view line) {
    const std::string value = words.size() > 1 ? words[1] : "";
    if (key == "scenarioepoch") {
      const std::string text(trimmed(trimmed(line).substr(key.size())));
      const auto epoch_s = utcSeconds(text);
      if (!epoch_s)
        refuse("ScenarioEpoch '" + printableText(text) + "' is no time such as 1 Jun 2003 12:00:00.000");
      epoch_s_ = *epoch_s;
      has_epoch_ = true;
    } else if (key == "centralbody" && lowerCase(value) != "earth") {
      refuse("CentralBody " + printableText(value) + ": only Earth is read");
    } else if (key == "coordinatesystem" && lowerCase(value) != "fixed") {
      refuse("CoordinateSystem " + printableText(value) +
             ": only Fixed is read; export the ephemeris in STK with the coordinate system Fixed");
    } else if (key == "distanceunit") {
      static const std::map<std::string, double> kUnits{
          {"meters", 1}, {"kilometers", 1000}, {"feet", 0.3048}, {"nauticalmiles", 1852}};
      const auto unit = kUnits.find(lowerCase(value));
      if (unit == kUnits.end())
        refuse("DistanceUnit " + printableText(value) +
               ": Meters, Kilometers, Feet and NauticalMiles are read");
      unit_m_ = unit->second;
    } else if (key == "timeformat" && lowerCase(value) != "epsec") {
      refuse("TimeFormat " + printableText(value) + ": only EpSec is read");
    } else if (key == "interpolationmethod") {
      is_linear_ = lowerCase(value) == "linear";
    } else if (key == "interpolationsamplesm1" || key == "interpolationorder") {
      degree_ = static_cast<int>(std::clamp(numberIn(value).value_or(1), 1.0, 12.0));
    } else if (key.rfind("ephemeris", 0) == 0) {
      takeSection(key, words[0]);
    }
  }

  void takeSection(const std::string& key, const std::string& name) {
    if (key.rfind("ephemeristimepos", 0) == 0) {
      section_ = Positions::cartesian;
    } else if (key.rfind("ephemerisllatimepos", 0) == 0) {
      section_ = Positions::geodetic;
    } else {
      refuse("section " + printableText(name) +
             ": EphemerisTimePos, EphemerisTimePosVel and EphemerisLLATimePos are read");
    }
  }

  void takeSample(const std::vector<std::string>& words) {
    ++recorder_.tally().records;
    std::array<double, 4> values{};
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto number = i < words.size() ? numberIn(words[i]) : std::nullopt;
      if (!number) return countBad(recorder_.tally(), location_, "it does not have a time and three numbers");
      values[i] = *number;
    }
    const double t_s = epoch_s_ + values[0];
    if (!samples_.empty() && t_s <= samples_.back().t_s)
      return countBad(recorder_.tally(), location_, "its time is not after the one before");
    recorder_.countSample();
    if (*section_ == Positions::cartesian) {
      samples_.push_back({t_s, Vec3d{values[1], values[2], values[3]} * unit_m_});
    } else if (std::abs(values[1]) > 90 || std::abs(values[2]) > 360) {
      countBad(recorder_.tally(), location_, "its latitude or longitude is out of range");
    } else {
      samples_.push_back({t_s, toEcef({values[1], values[2], values[3] * unit_m_})});
    }
  }

  std::string stem_, location_;
  TrackRecorder recorder_;
  std::size_t object_ = 0;
  std::optional<Positions> section_;
  std::vector<EcefSample> samples_;
  double epoch_s_ = 0, unit_m_ = 1;
  bool has_epoch_ = false, is_linear_ = false;
  int degree_ = 5;
};

}  // namespace

Recording readStkEphemeris(ByteSource& source, const std::string& name, const ReadOptions& options) {
  LineReader lines(source);
  return StkReader(name, options).read(lines);
}

}  // namespace emscape::interop
