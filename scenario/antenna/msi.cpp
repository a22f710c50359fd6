/// MSI/Planet antenna files, and the interpolation of a pattern in space from their two cuts.
///
/// The file gives the attenuation in the horizontal plane, H(azimuth), and in the vertical plane through
/// boresight, V(angle), whose angle runs from the horizon ahead (0) downwards to the nadir (90), the horizon
/// behind (180) and the zenith (270). Between them, horizontal projection interpolation is used:
///
///     A(az, el) = max(0, H(az) + (1 - w) (V(-el) - H(0)) + w (V(180 + el) - H(180))),   w = |az| / 180
///
/// It reproduces both cuts in their planes, and gives the usual sum of the two attenuations near the beam;
/// towards the rear the back of the vertical cut replaces its front. Limits: away from both planes,
/// particularly to the sides and behind, it is an estimate with errors of about 10 dB; at the zenith and the
/// nadir it depends on azimuth.
///
/// @see F. Gil, A. R. Claro, J. M. Ferreira, C. Pardelinha, L. M. Correia, "A 3D interpolation method for
/// base-station-antenna radiation patterns", IEEE Antennas and Propagation Magazine 43(2), 2001
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "emscape/base/log.h"
#include "emscape/base/units.h"
#include "scenario/antenna/cut.h"
#include "scenario/antenna/shapes.h"
#include "scenario/antenna/tables.h"
#include "scenario/antenna/text.h"

namespace emscape::scenario {
namespace {

struct MsiFile {
  std::string name;
  std::string title;  ///< the first line that is no keyword, before the cuts
  std::optional<double> gain_dbi;
  std::optional<double> tilt_deg;  ///< downwards
  std::vector<CutRow> horizontal, vertical;
};

class MsiReader {
 public:
  explicit MsiReader(const AntennaText& text) : text_(text) {}

  MsiFile read() {
    while (next_ < text_.lines().size()) readKeyword(text_.lines()[next_++]);
    return std::move(content_);
  }

 private:
  [[noreturn]] void fail(const TextField& field, const std::string& message) const {
    throw Error(ErrorCode::bad_input, text_.location(field), message);
  }

  void readKeyword(const TextField& line) {
    const std::vector<TextField> words = wordsOf(line);
    const std::string keyword = upperCase(words[0].text);
    const TextField value = restOf(line, words[0].text.size());
    if (keyword == "HORIZONTAL") {
      readCut(words, content_.horizontal);
    } else if (keyword == "VERTICAL") {
      readCut(words, content_.vertical);
    } else if (keyword == "GAIN") {
      content_.gain_dbi = gainIn(value);
    } else if (keyword == "NAME") {
      content_.name = std::string(value.text);
    } else if (keyword == "TILT" || keyword == "ELECTRICAL_TILT") {
      // TILT often contains a word (ELECTRICAL, MECHANICAL) instead of an angle.
      if (const auto tilt_deg = valueIn(value.text)) content_.tilt_deg = tilt_deg;
    } else if (words.size() == 2 && valueIn(words[0].text) && valueIn(words[1].text)) {
      fail(line,
           fmt::format(
               "'{}' is a row of numbers outside a HORIZONTAL or VERTICAL cut; more rows than announced?",
               line.text));
    } else if (content_.title.empty() && content_.horizontal.empty() && content_.vertical.empty()) {
      content_.title = std::string(line.text);
    }
    // Other keywords do not describe the pattern; manufacturers add their own.
  }

  /// A number; also with a decimal comma.
  static std::optional<double> valueIn(std::string_view text) {
    std::string with_point(text);
    if (std::count(text.begin(), text.end(), ',') == 1 && text.find('.') == std::string_view::npos)
      std::replace(with_point.begin(), with_point.end(), ',', '.');
    return numberIn(with_point);
  }

  void readCut(const std::vector<TextField>& words, std::vector<CutRow>& rows) {
    constexpr int kMinRows = 4;
    constexpr int kMaxRows = 36000;
    if (!rows.empty()) fail(words[0], fmt::format("a second {} cut", words[0].text));
    const std::optional<double> count = words.size() == 2 ? numberIn(words[1].text) : std::nullopt;
    if (!count || *count != std::floor(*count) || *count < kMinRows || *count > kMaxRows) {
      fail(words.size() < 2 ? words[0] : words[1],
           fmt::format("{} must be followed by its number of rows, {} to {}", words[0].text, kMinRows,
                       kMaxRows));
    }
    for (int i = 1; i <= static_cast<int>(*count); ++i) {
      if (next_ == text_.lines().size()) {
        fail(words[0],
             fmt::format("the file ends after {} of the {} rows of {}", i - 1, *count, words[0].text));
      }
      rows.push_back(rowIn(text_.lines()[next_++], fmt::format("row {} of {} {}", i, words[0].text, *count)));
    }
  }

  CutRow rowIn(const TextField& line, const std::string& what) const {
    const std::vector<TextField> words = wordsOf(line);
    if (words.size() != 2) {
      fail(line, fmt::format("{} is '{}'; it should be an angle and an attenuation", what, line.text));
    }
    const double angle_deg = numberWithin(words[0], -360, 360, what + ": angle", "deg");
    return {angle_deg, numberWithin(words[1], 0, kMaxAttenuation_db, what + ": attenuation", "dB"),
            words[0].line, words[0].column};
  }

  double numberWithin(const TextField& field, double lowest, double highest, const std::string& what,
                      const char* unit) const {
    const std::optional<double> value = valueIn(field.text);
    if (!value) fail(field, fmt::format("{} '{}' is not a number", what, field.text));
    if (*value < lowest || *value > highest) {
      fail(field,
           fmt::format("{} is {} {}; allowed are {} to {} {}", what, *value, unit, lowest, highest, unit));
    }
    return *value;
  }

  /// "17.5 dBi", "15,35dBd", "[dBi] 17.5", "17.5 (dBi)" or "15.35" (in dBd).
  double gainIn(const TextField& field) const {
    constexpr const char* kNumber = "+-.,0123456789";
    const std::size_t begin = std::min(field.text.find_first_of(kNumber), field.text.size());
    const std::size_t end = std::min(field.text.find_first_not_of(kNumber, begin), field.text.size());
    const TextField number{field.text.substr(begin, end - begin), field.line,
                           field.column + static_cast<int>(begin)};
    const double gain = numberWithin(begin < end ? number : field, -100, 100, "GAIN", "dB");
    const TextField unit =
        begin > 0 ? TextField{field.text.substr(0, begin), field.line, field.column} : restOf(field, end);
    std::string unit_name;
    for (const char c : upperCase(unit.text)) {
      if (std::string_view("[]() \t").find(c) == std::string_view::npos) unit_name += c;
    }
    if (unit_name == "DBI") return gain;
    if (unit_name.empty() || unit_name == "DBD") return gain + kDipoleGain_dbi;
    fail(unit, fmt::format("unit '{}' of GAIN; allowed are dBd (the default) and dBi", unit.text));
  }

  const AntennaText& text_;
  std::size_t next_ = 0;
  MsiFile content_;
};

double smallestAttenuation_db(const std::vector<CutRow>& rows) {
  return std::min_element(
             rows.begin(), rows.end(),
             [](const CutRow& a, const CutRow& b) { return a.attenuation_db < b.attenuation_db; })
      ->attenuation_db;
}

/// Angle (deg) of a cut's maximum.
double peakAngle_deg(const MeasuredCut& cut) {
  return *std::max_element(cut.angles_deg().begin(), cut.angles_deg().end(),
                           [&](double a, double b) { return cut.amplitudeAt(a) < cut.amplitudeAt(b); });
}

/// Difference (deg) of the stated tilt and the cut's maximum above which a warning is given.
constexpr double kTiltTolerance_deg = 2;

}  // namespace

AntennaPtr readMsi(const std::string& file, double gain_dbi) {
  const AntennaText text(file);
  MsiFile content = MsiReader(text).read();
  const SourceLocation location{file, 0, 0};
  if (content.horizontal.empty())
    throw Error(ErrorCode::bad_input, location, "no HORIZONTAL cut: not an MSI antenna file?");
  if (content.vertical.empty()) throw Error(ErrorCode::bad_input, location, "no VERTICAL cut");
  if (std::isnan(gain_dbi)) {
    if (!content.gain_dbi)
      throw Error(ErrorCode::bad_input, location, "no GAIN, and gain_dbi is not given with the file");
    gain_dbi = *content.gain_dbi;
  }
  requireGain(gain_dbi);
  // The horizontal cut may miss the maximum of a tilted beam; the vertical one passes through it.
  requireMaximum(smallestAttenuation_db(content.vertical), location, "VERTICAL cut");
  const MeasuredCut horizontal(AxisKind::circle, std::move(content.horizontal), location, "HORIZONTAL cut");
  const MeasuredCut vertical(AxisKind::circle, std::move(content.vertical), location, "VERTICAL cut");

  if (content.tilt_deg && std::abs(peakAngle_deg(vertical) - *content.tilt_deg) > kTiltTolerance_deg) {
    logWarning(fmt::format(
        "{}: the file states {} deg of tilt, but its VERTICAL cut has its maximum at {} deg; the cut is "
        "used unchanged",
        file, *content.tilt_deg, peakAngle_deg(vertical)));
  }

  const GridNodes nodes = gridNodes(horizontal.angles_deg(), vertical.angles_deg());
  std::vector<double> horizontal_db;
  for (const double azimuth_deg : nodes.azimuths_deg)
    horizontal_db.push_back(horizontal.attenuationAt_db(azimuth_deg));
  const double ahead_db = horizontal.attenuationAt_db(0);
  const double behind_db = horizontal.attenuationAt_db(180);
  std::vector<float> amplitudes;
  for (const double elevation_deg : nodes.elevations_deg) {
    const double front_db = vertical.attenuationAt_db(-elevation_deg) - ahead_db;
    const double back_db = vertical.attenuationAt_db(180 + elevation_deg) - behind_db;
    for (std::size_t i = 0; i < horizontal_db.size(); ++i) {
      const double w = std::abs(nodes.azimuths_deg[i]) / 180;
      const double attenuation_db = horizontal_db[i] + (1 - w) * front_db + w * back_db;
      amplitudes.push_back(static_cast<float>(amplitudeOfAttenuation(std::max(attenuation_db, 0.0))));
    }
  }
  return makeGridAntenna(nodes, std::move(amplitudes), gain_dbi,
                         !content.name.empty()    ? content.name
                         : !content.title.empty() ? content.title
                                                  : "MSI pattern");
}

AntennaPtr readMsi(const std::string& file) {
  return readMsi(file, std::numeric_limits<double>::quiet_NaN());
}

}  // namespace emscape::scenario
