/// MSI/Planet antenna files: the attenuation in the horizontal plane, H(azimuth), and in the vertical plane
/// through boresight, V(angle), whose angle runs from the horizon ahead (0) downwards to the nadir (90), the
/// horizon behind (180) and the zenith (270).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "document/text_lines.h"
#include "emscape/base/units.h"
#include "scenario/antenna/cut.h"
#include "scenario/antenna/pattern_file.h"
#include "scenario/antenna/shapes.h"
#include "scenario/antenna/tables.h"

namespace emscape::scenario {
namespace {

using document::numberIn;
using document::numberOrCommaIn;
using document::restOf;
using document::TextField;
using document::TextLines;
using document::upperCase;
using document::wordsOf;

struct MsiFile {
  std::string name;
  std::string title;  ///< the first line that is no keyword, before the cuts
  std::optional<double> gain_dbi;
  bool is_gain_unit_assumed = false;
  std::optional<double> electrical_tilt_deg, mechanical_tilt_deg;  ///< downwards
  std::optional<double> width_az_deg, width_el_deg;
  StatedBand band;
  std::vector<std::string> ignored;  ///< first words of lines that do not describe the pattern
  std::vector<CutRow> horizontal, vertical;
};

class MsiReader {
 public:
  explicit MsiReader(const TextLines& text) : text_(text) {}

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
    } else if (const auto band = keyword == "FREQUENCY" ? bandIn(value.text) : std::nullopt) {
      content_.band = *band;
    } else if (keyword == "TILT" || keyword == "ELECTRICAL_TILT" || keyword == "MECHANICAL_TILT") {
      // TILT often contains a word (ELECTRICAL, MECHANICAL) instead of an angle, or beside it.
      const bool is_mechanical = upperCase(line.text).find("MECHANICAL") != std::string::npos;
      for (std::size_t i = 1; i < words.size(); ++i) {
        if (const auto tilt_deg = numberOrCommaIn(words[i].text))
          (is_mechanical ? content_.mechanical_tilt_deg : content_.electrical_tilt_deg) = tilt_deg;
      }
    } else if (keyword == "H_WIDTH") {
      content_.width_az_deg = numberOrCommaIn(value.text);
    } else if (keyword == "V_WIDTH") {
      content_.width_el_deg = numberOrCommaIn(value.text);
    } else if (hasCut() && words.size() == 2 && numberOrCommaIn(words[0].text) &&
               numberOrCommaIn(words[1].text)) {
      fail(line,
           fmt::format(
               "'{}' is a row of numbers outside a HORIZONTAL or VERTICAL cut; more rows than announced?",
               line.text));
    } else {
      // Other keywords do not describe the pattern; manufacturers add their own.
      if (content_.title.empty() && !hasCut()) content_.title = std::string(line.text);
      content_.ignored.emplace_back(words[0].text);
    }
  }

  bool hasCut() const { return !content_.horizontal.empty() || !content_.vertical.empty(); }

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
    return {angle_deg,
            numberWithin(words[1], -kMaxAttenuation_db, kMaxAttenuation_db, what + ": attenuation", "dB"),
            words[0].line, words[0].column};
  }

  double numberWithin(const TextField& field, double lowest, double highest, const std::string& what,
                      const char* unit) const {
    const std::optional<double> value = numberOrCommaIn(field.text);
    if (!value) fail(field, fmt::format("{} '{}' is not a number", what, field.text));
    if (*value < lowest || *value > highest) {
      fail(field,
           fmt::format("{} is {} {}; allowed are {} to {} {}", what, *value, unit, lowest, highest, unit));
    }
    return *value;
  }

  /// "17.5 dBi", "15,35dBd", "[dBi] 17.5", "17.5 (dBi)" or "15.35" (in dBd).
  double gainIn(const TextField& field) {
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
    content_.is_gain_unit_assumed = unit_name.empty();
    if (unit_name.empty() || unit_name == "DBD") return gain + kDipoleGain_dbi;
    fail(unit, fmt::format("unit '{}' of GAIN; allowed are dBd (the default) and dBi", unit.text));
  }

  /// "900", "(MHz) 900", "880-960" or "2.9GHz", in MHz without a unit; none for other texts.
  static std::optional<StatedBand> bandIn(std::string_view text) {
    std::string numbers;
    const std::string upper = upperCase(text);
    const double unit_hz = upper.find("GHZ") != std::string::npos ? 1e9 : 1e6;
    for (const char c : upper) {
      if (std::string_view("[]() \tGMHZ").find(c) == std::string_view::npos) numbers += c;
    }
    const std::size_t dash = std::min(numbers.find('-'), numbers.size());
    const auto low = numberOrCommaIn(numbers.substr(0, dash));
    const auto high = dash < numbers.size() ? numberOrCommaIn(numbers.substr(dash + 1)) : low;
    if (!low || !high || !(*low > 0 && *high >= *low)) return std::nullopt;
    return StatedBand{*low * unit_hz, *high * unit_hz};
  }

  const TextLines& text_;
  std::size_t next_ = 0;
  MsiFile content_;
};

double smallestAttenuation_db(const std::vector<CutRow>& rows) {
  return std::min_element(
             rows.begin(), rows.end(),
             [](const CutRow& a, const CutRow& b) { return a.attenuation_db < b.attenuation_db; })
      ->attenuation_db;
}

/// Turns the gains of a cut, all of them 0 or below, to attenuations.
void turnGains(const std::string& file, const char* name, std::vector<CutRow>& rows, PatternFile& pattern) {
  const auto by_value = [](const CutRow& a, const CutRow& b) { return a.attenuation_db < b.attenuation_db; };
  const auto [smallest, largest] = std::minmax_element(rows.begin(), rows.end(), by_value);
  if (smallest->attenuation_db >= 0) return;
  if (largest->attenuation_db > 0) {
    throw Error(
        ErrorCode::bad_input, {file, smallest->line, smallest->column},
        fmt::format("{} {}: attenuation is {} dB; allowed are 0 to {} dB, or gains of 0 dB and below in "
                    "all rows",
                    name, smallest->angle_deg, smallest->attenuation_db, kMaxAttenuation_db));
  }
  pattern.warnings.push_back(fmt::format(
      "{}: the {} cut has gains relative to the maximum, down to {} dB, where the format has attenuations; "
      "their signs are changed",
      file, name, smallest->attenuation_db));
  for (CutRow& row : rows) row.attenuation_db = std::abs(row.attenuation_db);
}

/// Difference (deg) of the stated tilt and the cut's maximum above which a warning is given.
constexpr double kTiltTolerance_deg = 2;

}  // namespace

PatternFile readMsiPattern(const std::string& file) {
  const TextLines text(file);
  MsiFile content = MsiReader(text).read();
  const SourceLocation location{file, 0, 0};
  if (content.horizontal.empty()) {
    throw Error(
        ErrorCode::bad_input, location,
        "no HORIZONTAL cut: not an MSI antenna file? Others are .adf (NSMA), .ant and .pattern (STK), "
        ".az and .el (SPLAT!) and .csv, as which a table of theta, phi and gain (text of a field solver) is "
        "read "
        "with the columns theta_deg,phi_deg,gain_dbi");
  }
  if (content.vertical.empty()) throw Error(ErrorCode::bad_input, location, "no VERTICAL cut");
  PatternFile pattern;
  pattern.format = "MSI/Planet file";
  pattern.name = !content.name.empty()    ? content.name
                 : !content.title.empty() ? content.title
                                          : "MSI pattern";
  pattern.gain_dbi = content.gain_dbi;
  if (content.is_gain_unit_assumed)
    pattern.gain_warning = fmt::format(
        "{}: its GAIN has no unit and is taken as dBd, as the format defines: {:g} dBi. If it is in dBi, "
        "'gain_dbi: {:g}' of the antenna states it",
        file, *content.gain_dbi, *content.gain_dbi - kDipoleGain_dbi);
  pattern.stated_band = content.band;
  pattern.stated_az_deg = content.width_az_deg;
  pattern.stated_el_deg = content.width_el_deg;
  turnGains(file, "HORIZONTAL", content.horizontal, pattern);
  turnGains(file, "VERTICAL", content.vertical, pattern);
  // The horizontal cut may miss the maximum of a tilted beam; the vertical one passes through it.
  requireMaximum(smallestAttenuation_db(content.vertical), location, "VERTICAL cut");
  const MeasuredCut horizontal(AxisKind::circle, std::move(content.horizontal), location, "HORIZONTAL cut");
  const MeasuredCut vertical(AxisKind::circle, std::move(content.vertical), location, "VERTICAL cut");
  // A cut holds the electrical tilt; a mechanical one is that of the mounting, or is in the cut, too.
  const double mechanical_deg = content.mechanical_tilt_deg.value_or(0);
  const double tilt_deg = content.electrical_tilt_deg.value_or(mechanical_deg);
  const auto isAt = [&](double angle_deg) {
    return std::abs(peakAngle_deg(vertical) - angle_deg) <= kTiltTolerance_deg;
  };
  if (!isAt(tilt_deg) && !isAt(tilt_deg + mechanical_deg) &&
      (content.electrical_tilt_deg || content.mechanical_tilt_deg)) {
    pattern.warnings.push_back(fmt::format(
        "{}: the file states {} deg of tilt, but its VERTICAL cut has its maximum at {} deg; the cut is "
        "used unchanged",
        file, tilt_deg, peakAngle_deg(vertical)));
  }
  noteIgnored(pattern, "lines", content.ignored);
  fillFromCuts(file, horizontal, vertical, pattern);
  return pattern;
}

}  // namespace emscape::scenario
