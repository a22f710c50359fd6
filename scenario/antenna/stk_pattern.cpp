/// External antenna patterns of STK: a keyword of the angles, and rows of two angles and a gain in dBi.
///
/// PhiTheta and ThetaPhi: theta from boresight, phi about it. AzEl and ElAz: azimuth to the right, elevation
/// upwards. Symmetric: the angle from boresight alone. The pattern's first angle is that of its first column.
///
/// @see help.agi.com, "External antenna pattern files"
#include <fmt/format.h>

#include <cmath>

#include "document/text_lines.h"
#include "emscape/base/units.h"
#include "scenario/antenna/sphere.h"

namespace emscape::scenario {
namespace {

using document::TextField;
using document::TextLines;

struct StkKind {
  const char* keyword;
  SphereAngles angles;
  bool first_is_second;  ///< the columns are elevation, azimuth or theta, phi
  int columns;
};
constexpr StkKind kStkKinds[] = {
    {"PHITHETAPATTERN", SphereAngles::theta_from_boresight, false, 3},
    {"THETAPHIPATTERN", SphereAngles::theta_from_boresight, true, 3},
    {"AZELPATTERN", SphereAngles::azimuth_elevation, false, 3},
    {"ELAZPATTERN", SphereAngles::azimuth_elevation, true, 3},
    {"SYMMETRICPATTERN", SphereAngles::theta_from_boresight, true, 2},
};

class StkReader {
 public:
  explicit StkReader(const TextLines& text) : text_(text) {}

  PatternFile read() {
    PatternFile pattern;
    pattern.format = "STK pattern";
    pattern.name = "STK pattern";
    for (const TextField& line : text_.lines()) readLine(line, pattern);
    if (kind_ == nullptr) {
      throw Error(ErrorCode::bad_input, {text_.file(), 0, 0},
                  "no keyword of the angles: PhiThetaPattern, ThetaPhiPattern, AzElPattern, ElAzPattern or "
                  "SymmetricPattern");
    }
    if (count_ && *count_ != static_cast<double>(rows_read_)) {
      throw Error(ErrorCode::bad_input, {text_.file(), 0, 0},
                  fmt::format("NumberOfPoints is {:g}, but PatternData has {} rows", *count_, rows_read_));
    }
    noteIgnored(pattern, "lines", ignored_);
    if (kind_->columns == 2 || kind_->angles == SphereAngles::theta_from_boresight) {
      pattern.notes.push_back("theta is from boresight; phi from the left, 0, upwards, 90");
    } else {
      pattern.notes.push_back("azimuth is clockwise from boresight, elevation upwards");
    }
    pattern.gain_dbi = fillFromSphere(kind_->angles, std::move(rows_), text_.file(), pattern).max_db;
    return pattern;
  }

 private:
  [[noreturn]] void fail(const TextField& field, const std::string& message) const {
    throw Error(ErrorCode::bad_input, text_.location(field), message);
  }

  void readLine(const TextField& line, PatternFile& pattern) {
    const std::vector<TextField> words = document::wordsOf(line);
    const std::string keyword = document::upperCase(words[0].text);
    if (is_data_ && document::numberIn(words[0].text)) {
      readRow(words);
      return;
    }
    for (const StkKind& kind : kStkKinds) {
      if (keyword != kind.keyword) continue;
      if (kind_ != nullptr) fail(line, "a second keyword of the angles");
      kind_ = &kind;
      return;
    }
    if (keyword == "ANGLEUNITS") {
      const std::string unit = words.size() > 1 ? document::upperCase(words[1].text) : "";
      if (unit != "DEGREES" && unit != "RADIANS") fail(line, "AngleUnits must be Degrees or Radians");
      is_in_radians_ = unit == "RADIANS";
    } else if (keyword == "NUMBEROFPOINTS") {
      count_ = words.size() > 1 ? document::numberIn(words[1].text) : std::nullopt;
      if (!count_) fail(line, "NumberOfPoints must be followed by a number");
    } else if (keyword == "IEEE1979") {
      fail(line, "patterns of two polarisations (IEEE1979) are not read; write the total gain in dBi");
    } else if (keyword == "PATTERNDATA") {
      is_data_ = true;
    } else if (keyword == "ANTENNANAME" || keyword == "DESCRIPTION") {
      pattern.name = std::string(document::restOf(line, words[0].text.size()).text);
    } else if (keyword.rfind("STK.V", 0) != 0 && keyword.rfind("BEGIN", 0) != 0 &&
               keyword.rfind("END", 0) != 0) {
      ignored_.emplace_back(words[0].text);
    }
  }

  void readRow(const std::vector<TextField>& words) {
    if (kind_ == nullptr) fail(words[0], "rows before the keyword of the angles, such as ThetaPhiPattern");
    if (static_cast<int>(words.size()) != kind_->columns) {
      fail(words[0], fmt::format("{} values; a row has {}: {} and the gain in dBi", words.size(),
                                 kind_->columns, kind_->columns == 2 ? "an angle" : "two angles"));
    }
    double values[3] = {};
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::optional<double> value = document::numberIn(words[i].text);
      if (!value) fail(words[i], fmt::format("'{}' is not a number", words[i].text));
      const bool is_gain = i + 1 == words.size();
      values[i] = !is_gain && is_in_radians_ ? radToDeg(*value) : *value;
      const double limit = is_gain ? kMaxAttenuation_db : 360;
      if (std::abs(values[i]) > limit)
        fail(words[i], fmt::format("{} is outside -{} to {}", values[i], limit, limit));
    }
    ++rows_read_;
    if (kind_->columns == 2) {
      for (const double phi_deg : {0.0, 90.0, 180.0, 270.0})
        rows_.push_back({phi_deg, std::abs(values[0]), values[1], words[0].line});
      return;
    }
    const int first = kind_->first_is_second ? 1 : 0;
    const double second_deg = values[1 - first];
    const double lowest_deg = kind_->angles == SphereAngles::azimuth_elevation ? -90 : -180;
    if (second_deg < lowest_deg - 1e-9 || second_deg > -lowest_deg + 1e-9)
      fail(words[0],
           fmt::format("{:g} deg is outside {:g} to {:g} deg", second_deg, lowest_deg, -lowest_deg));
    rows_.push_back({values[first], second_deg, values[2], words[0].line});
  }

  const TextLines& text_;
  const StkKind* kind_ = nullptr;
  bool is_in_radians_ = false, is_data_ = false;
  std::optional<double> count_;
  std::size_t rows_read_ = 0;
  std::vector<SphereRow> rows_;
  std::vector<std::string> ignored_;
};

}  // namespace

PatternFile readStkPattern(const std::string& file) {
  const TextLines text(file);
  return StkReader(text).read();
}

}  // namespace emscape::scenario
