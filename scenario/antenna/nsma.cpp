/// Antenna files of NSMA, lines "KEY:,value": cuts of gains relative to the maximum, in dB.
///
/// Azimuth cuts (PATCUT H or AZ) run clockwise, elevation cuts (V or EL) upwards from the horizon ahead.
/// Cuts of the cross-polar field and of other planes are left out. Without an elevation cut, one of ELWIDT
/// and ELTILT is used, or the azimuth cut of a beam that is as wide in both planes.
///
/// @see NSMA Recommendation WG 16.99.050, "Antenna systems - standard format for digitized antenna patterns"
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "document/text_lines.h"
#include "emscape/base/units.h"
#include "scenario/antenna/pattern_file.h"

namespace emscape::scenario {
namespace {

using document::TextField;
using document::TextLines;

constexpr double kMaxNsmaAngle_deg = 360;

struct NsmaCut {
  std::string plane;         ///< "H", "V", "AZ", "EL", ...
  std::string polarization;  ///< "V/V": of the antenna and of the wave
  std::vector<CutRow> rows;  ///< gains as attenuation_db, sign unchanged

  bool isAzimuth() const { return plane == "H" || plane == "AZ"; }
  bool isElevation() const { return plane == "V" || plane == "EL"; }
  bool isCrossPolar() const {
    const std::size_t slash = polarization.find('/');
    return slash != std::string::npos && polarization.substr(0, slash) != polarization.substr(slash + 1);
  }
  std::string name() const { return plane + (polarization.empty() ? "" : " " + polarization); }
};

struct NsmaContent {
  std::string maker, model, gain_units;
  std::optional<double> gain, width_az_deg, width_el_deg, tilt_deg;
  StatedBand band;
  TextField gain_field;
  std::vector<NsmaCut> cuts;
  std::vector<std::string> ignored;
};

class NsmaReader {
 public:
  explicit NsmaReader(const TextLines& text) : text_(text) {}

  NsmaContent read() {
    while (next_ < text_.lines().size() && !has_ended_) readLine(text_.lines()[next_++]);
    return std::move(content_);
  }

 private:
  [[noreturn]] void fail(const TextField& field, const std::string& message) const {
    throw Error(ErrorCode::bad_input, text_.location(field), message);
  }

  void readLine(const TextField& line) {
    const std::size_t colon = line.text.find(':');
    if (colon == std::string_view::npos) {
      if (!content_.cuts.empty() && pairOf(line))
        fail(line, fmt::format("'{}' is a row of numbers after the NUPOIN rows of its cut", line.text));
      content_.ignored.emplace_back(line.text.substr(0, 20));
      return;
    }
    const std::string key = document::upperCase(document::withoutBlanks(line.text.substr(0, colon)));
    const std::size_t comma = line.text.find(',', colon);
    const TextField value = document::restOf(
        line, std::min(comma == std::string_view::npos ? colon + 1 : comma + 1, line.text.size()));
    if (key == "ANTMAN") {
      content_.maker = std::string(value.text);
    } else if (key == "MODNUM") {
      content_.model = std::string(value.text);
    } else if (key == "GUNITS") {
      content_.gain_units = document::upperCase(value.text);
    } else if (key == "MDGAIN") {
      content_.gain = numberOf(value, "MDGAIN", -100, 100);
      content_.gain_field = value;
    } else if (key == "AZWIDT") {
      content_.width_az_deg = document::numberOrCommaIn(value.text);
    } else if (key == "ELWIDT") {
      content_.width_el_deg = document::numberOrCommaIn(value.text);
    } else if (key == "ELTILT") {
      content_.tilt_deg = document::numberOrCommaIn(value.text);
    } else if (key == "LOWFRQ" || key == "HGHFRQ") {
      const std::optional<double> frequency_mhz = document::numberOrCommaIn(value.text);
      double& end_hz = key == "LOWFRQ" ? content_.band.lowest_hz : content_.band.highest_hz;
      if (frequency_mhz && *frequency_mhz > 0) end_hz = *frequency_mhz * 1e6;
    } else if (key == "PATCUT") {
      content_.cuts.emplace_back();
      content_.cuts.back().plane = document::upperCase(value.text);
    } else if (key == "POLARI" && !content_.cuts.empty()) {
      content_.cuts.back().polarization = document::upperCase(value.text);
    } else if (key == "NUPOIN") {
      readRows(value);
    } else if (key == "ENDFIL") {
      has_ended_ = true;
    } else if (key != "REVNUM" && key != "REVDAT" && key != "NUMCUT" && key != "FSTLST") {
      content_.ignored.push_back(key);
    }
  }

  void readRows(const TextField& field) {
    if (content_.cuts.empty()) fail(field, "NUPOIN before PATCUT: no cut has begun");
    NsmaCut& cut = content_.cuts.back();
    if (!cut.rows.empty()) fail(field, "a second NUPOIN of one cut");
    const int count = static_cast<int>(numberOf(field, "NUPOIN", 2, 36000));
    // FSTLST, the first and the last angle, stands between NUPOIN and the rows.
    while (next_ < text_.lines().size() && text_.lines()[next_].text.find(':') != std::string_view::npos)
      ++next_;
    for (int i = 1; i <= count; ++i) {
      const bool has_line = next_ < text_.lines().size();
      const auto pair = has_line ? pairOf(text_.lines()[next_]) : std::nullopt;
      if (!pair) {
        fail(has_line ? text_.lines()[next_] : field,
             fmt::format("row {} of {} of cut {} is no angle and gain: 'angle,dB'", i, count, cut.name()));
      }
      const TextField& line = text_.lines()[next_++];
      if (std::abs(pair->first) > kMaxNsmaAngle_deg)
        fail(line, fmt::format("the angle is {} deg; allowed are -360 to 360 deg", pair->first));
      cut.rows.push_back({pair->first, pair->second, line.line, line.column});
    }
  }

  /// "angle,gain" or "angle,gain,phase".
  static std::optional<std::pair<double, double>> pairOf(const TextField& line) {
    const std::size_t comma = line.text.find_first_of(",\t ");
    if (comma == std::string_view::npos) return std::nullopt;
    const std::string_view rest = document::withoutBlanks(line.text.substr(comma + 1));
    const auto angle = document::numberIn(document::withoutBlanks(line.text.substr(0, comma)));
    const auto gain = document::numberIn(document::withoutBlanks(rest.substr(0, rest.find(','))));
    if (!angle || !gain) return std::nullopt;
    return std::pair(*angle, *gain);
  }

  double numberOf(const TextField& field, const char* key, double lowest, double highest) const {
    const std::optional<double> value = document::numberOrCommaIn(field.text);
    if (!value) fail(field, fmt::format("{} is '{}', not a number", key, field.text));
    if (*value < lowest || *value > highest)
      fail(field, fmt::format("{} is {}; allowed are {} to {}", key, *value, lowest, highest));
    return *value;
  }

  const TextLines& text_;
  std::size_t next_ = 0;
  bool has_ended_ = false;
  NsmaContent content_;
};

/// Gains to attenuations below the maximum of a cut. @return the maximum
double turnToAttenuations(std::vector<CutRow>& rows) {
  double max_db = -HUGE_VAL;
  for (const CutRow& row : rows) max_db = std::max(max_db, row.attenuation_db);
  for (CutRow& row : rows) row.attenuation_db = std::min(max_db - row.attenuation_db, kMaxAttenuation_db);
  return max_db;
}

/// Cut of a Gaussian beam with its axis at an angle (deg), and -30 dB outside.
std::vector<CutRow> beamCut(double width_deg, double axis_deg) {
  constexpr double kFloor_db = 30;
  std::vector<CutRow> rows;
  for (int angle = -180; angle < 180; ++angle) {
    const double off = std::remainder(angle - axis_deg, 360.0) / width_deg;
    rows.push_back({static_cast<double>(angle), std::min(12.041 * off * off, kFloor_db), 0, 0});
  }
  return rows;
}

class NsmaPattern {
 public:
  NsmaPattern(const std::string& file, NsmaContent content) : file_(file), content_(std::move(content)) {}

  PatternFile make() {
    if (content_.cuts.empty())
      throw Error(ErrorCode::bad_input, {file_, 0, 0}, "no PATCUT: an NSMA file has cuts");
    pattern_.format = "NSMA file";
    pattern_.name =
        content_.maker + (content_.maker.empty() || content_.model.empty() ? "" : " ") + content_.model;
    if (pattern_.name.empty()) pattern_.name = "NSMA pattern";
    readUnits();
    pattern_.stated_az_deg = content_.width_az_deg;
    pattern_.stated_band = content_.band;
    std::vector<CutRow> azimuth = chosen(&NsmaCut::isAzimuth, "azimuth");
    std::vector<CutRow> elevation = chosen(&NsmaCut::isElevation, "elevation");
    for (const NsmaCut& cut : content_.cuts) {
      if (!cut.isAzimuth() && !cut.isElevation()) content_.ignored.push_back("cut " + cut.name());
    }
    if (azimuth.empty()) {
      throw Error(
          ErrorCode::bad_input, {file_, 0, 0},
          fmt::format("no azimuth cut (PATCUT H or AZ); the first cut is {}", content_.cuts.front().name()));
    }
    const MeasuredCut horizontal(AxisKind::circle, std::move(azimuth), {file_, 0, 0}, "azimuth cut");
    const MeasuredCut vertical(AxisKind::circle,
                               elevation.empty() ? withoutElevation() : downwards(std::move(elevation)),
                               {file_, 0, 0}, "elevation cut");
    checkTilt(vertical);
    noteIgnored(pattern_, "lines and cuts", content_.ignored);
    fillFromCuts(file_, horizontal, vertical, pattern_);
    return std::move(pattern_);
  }

 private:
  void readUnits() {
    const std::string& units = content_.gain_units;
    const std::string gain_unit = units.substr(0, units.find('/'));
    if (!units.empty() && gain_unit != "DBI" && gain_unit != "DBD") {
      throw Error(
          ErrorCode::bad_input, {file_, 0, 0},
          fmt::format("GUNITS is '{}': allowed are DBI and DBD for the gain, with DBR, DBI or DBD for "
                      "the pattern, such as DBI/DBR",
                      units));
    }
    if (units.find("/LIN") != std::string::npos)
      throw Error(ErrorCode::bad_input, {file_, 0, 0},
                  "GUNITS is '" + units + "': the pattern must be in dB");
    if (!content_.gain) return;
    if (units.empty())
      pattern_.warnings.push_back(file_ + ": MDGAIN without GUNITS; it is taken as a gain in dBi");
    pattern_.gain_dbi = *content_.gain + (gain_unit == "DBD" ? kDipoleGain_dbi : 0);
  }

  /// The first co-polar cut of a plane, as attenuations; empty: there is none.
  std::vector<CutRow> chosen(bool (NsmaCut::*isOfPlane)() const, const char* plane) {
    std::vector<CutRow> rows;
    std::string name;
    for (const NsmaCut& cut : content_.cuts) {
      if (!(cut.*isOfPlane)()) continue;
      if (cut.isCrossPolar() || !name.empty()) {
        content_.ignored.push_back("cut " + cut.name());
        continue;
      }
      name = cut.name();
      rows = cut.rows;
    }
    if (rows.empty()) return rows;
    const double max_db = turnToAttenuations(rows);
    pattern_.notes.push_back(fmt::format("{}: cut {}", plane, name));
    constexpr double kAboutZero_db = 1;
    const bool is_absolute =
        pattern_.gain_dbi && content_.gain && std::abs(max_db - *content_.gain) <= kAboutZero_db;
    if (std::abs(max_db) > kAboutZero_db && !is_absolute) {
      pattern_.warnings.push_back(
          fmt::format("{}: the largest value of cut {} is {:g} dB, neither 0 nor the gain: the cut is used "
                      "relative to it",
                      file_, name, max_db));
    }
    return rows;
  }

  /// Angles of fillFromCuts() run downwards.
  static std::vector<CutRow> downwards(std::vector<CutRow> rows) {
    for (CutRow& row : rows) row.angle_deg = -row.angle_deg;
    return rows;
  }

  std::vector<CutRow> withoutElevation() {
    const double width_deg = content_.width_el_deg.value_or(content_.width_az_deg.value_or(0));
    if (!(width_deg > 0 && width_deg <= 180)) {
      throw Error(ErrorCode::bad_input, {file_, 0, 0},
                  "no elevation cut (PATCUT V or EL), and no ELWIDT from which to make one");
    }
    const double tilt_deg = content_.tilt_deg.value_or(0);
    pattern_.warnings.push_back(fmt::format(
        "{}: no elevation cut; a Gaussian beam of ELWIDT, {:g} deg, at ELTILT, {:g} deg downwards, "
        "is used, with a floor 30 dB below the maximum",
        file_, width_deg, tilt_deg));
    return beamCut(width_deg, tilt_deg);
  }

  void checkTilt(const MeasuredCut& vertical) {
    constexpr double kTolerance_deg = 2;
    if (!content_.tilt_deg) return;
    const double peak_deg = peakAngle_deg(vertical);
    if (std::abs(peak_deg - *content_.tilt_deg) <= kTolerance_deg) return;
    pattern_.warnings.push_back(
        fmt::format("{}: ELTILT is {:g} deg downwards, but the elevation cut has its maximum {:g} deg {} the "
                    "horizon; the cut is used unchanged",
                    file_, *content_.tilt_deg, std::abs(peak_deg), peak_deg > 0 ? "below" : "above"));
  }

  const std::string file_;
  NsmaContent content_;
  PatternFile pattern_;
};

}  // namespace

PatternFile readNsma(const std::string& file) {
  const TextLines text(file);
  return NsmaPattern(file, NsmaReader(text).read()).make();
}

}  // namespace emscape::scenario
