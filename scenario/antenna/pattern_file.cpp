#include "scenario/antenna/pattern_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "document/csv.h"
#include "document/text_lines.h"
#include "emscape/base/log.h"
#include "scenario/antenna/shapes.h"
#include "scenario/terrain/file_names.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;

std::string endingOf(const std::string& file) {
  return document::upperCase(fs::path(file).extension().string());
}

/// The file beside one of a SPLAT! pattern with the other ending, in the case of letters that exists.
std::string splatPartner(const std::string& file, const char* lower, const char* upper) {
  for (const char* ending : {lower, upper}) {
    const fs::path other = fs::path(file).replace_extension(ending);
    std::error_code ignored;
    if (fs::exists(other, ignored)) return other.string();
  }
  return "";
}

/// True for a CSV file with no other columns than those of a grid.
bool isOwnGrid(const std::string& file) {
  const std::vector<std::string> names = document::csvColumnsOf(file);
  const bool is_own = std::all_of(names.begin(), names.end(), [](const std::string& name) {
    return name == "azimuth_deg" || name == "elevation_deg" || name == "attenuation_db";
  });
  return is_own;
}

/// A stated beamwidth that differs from the measured one.
void addWidthContradiction(std::vector<std::string>& warnings, const std::string& file, const char* plane,
                           const std::optional<double>& stated_deg, double measured_deg) {
  constexpr double kPart = 0.25, kSmallest_deg = 2;
  if (!stated_deg || !(*stated_deg > 0)) return;
  if (std::abs(*stated_deg - measured_deg) <= std::max(kSmallest_deg, kPart * *stated_deg)) return;
  warnings.push_back(fmt::format(
      "{}: the file states a beamwidth of {:g} deg in {}, but its pattern is {:.1f} deg wide; the "
      "pattern is used",
      file, *stated_deg, plane, measured_deg));
}

}  // namespace

PatternFile readPatternFile(const std::string& file) {
  if (const std::string packed = packedFileText(file); !packed.empty())
    throw Error(ErrorCode::bad_input, {file, 0, 0}, "an antenna file is read unpacked: " + packed);
  const std::string ending = endingOf(file);
  if (ending == ".AZ") return readSplat(file, splatPartner(file, ".el", ".EL"));
  if (ending == ".EL") return readSplat(splatPartner(file, ".az", ".AZ"), file);
  if (ending == ".CSV") return isOwnGrid(file) ? readGridPattern(file) : readTablePattern(file);
  const document::TextLines text(file);
  for (std::size_t i = 0; i < std::min<std::size_t>(text.lines().size(), 40); ++i) {
    const std::string line = document::upperCase(text.lines()[i].text);
    if (line.rfind("REVNUM:", 0) == 0 || line.rfind("PATCUT:", 0) == 0) return readNsma(file);
    if (line.rfind("STK.V", 0) == 0 || line.rfind("PATTERNDATA", 0) == 0) return readStkPattern(file);
  }
  return readMsiPattern(file);
}

namespace {

/// The azimuth of the horizontal cut that is ahead in the vertical one: 0, or that of its maximum where they
/// contradict each other.
double azimuthAhead(const std::string& file, const MeasuredCut& horizontal, const MeasuredCut& vertical,
                    PatternFile& pattern) {
  constexpr double kTolerance_db = 3, kLargestTilt_deg = 45;
  const double horizontal_db = horizontal.attenuationAt_db(0) + 0.0,
               vertical_db = vertical.attenuationAt_db(0) + 0.0;  // 0, not -0
  const double peak_deg = peakAngle_deg(vertical);
  const bool is_turned = horizontal_db > vertical_db + kTolerance_db;
  const bool is_raised = vertical_db > horizontal_db + kTolerance_db && std::abs(peak_deg) > kLargestTilt_deg;
  if (!is_turned && !is_raised) return 0;
  const double ahead_deg = is_turned ? peakAngle_deg(horizontal) : 0;
  pattern.warnings.push_back(fmt::format(
      "{}: the cuts contradict each other ahead, at azimuth 0 on the horizon: {:.1f} dB below the "
      "maximum in the horizontal cut, {:.1f} dB in the vertical one. {}",
      file, horizontal_db, vertical_db,
      is_turned ? fmt::format("The vertical cut is taken as that at azimuth {:g} deg, the maximum of "
                              "the horizontal one",
                              ahead_deg)
                : fmt::format("The maximum of the vertical cut is {:g} deg below the horizon: does it "
                              "count from the zenith?",
                              peak_deg)));
  return ahead_deg;
}

/// Angles without rows, far wider than between the others, over which the pattern changes: it is interpolated
/// there.
void addHoles(const std::string& file, const char* name, const MeasuredCut& cut, PatternFile& pattern) {
  constexpr double kWide_deg = 10, kChange_db = 3;
  const std::vector<double>& angles_deg = cut.angles_deg();
  const double widest_deg = std::max(kWide_deg, 3 * 360.0 / static_cast<double>(angles_deg.size()));
  for (std::size_t i = 0; i < angles_deg.size(); ++i) {
    const bool is_last = i + 1 == angles_deg.size();
    const double next_deg = is_last ? angles_deg.front() + 360 : angles_deg[i + 1];
    const double change_db = std::abs(cut.attenuationAt_db(next_deg) - cut.attenuationAt_db(angles_deg[i]));
    if (next_deg - angles_deg[i] <= widest_deg || change_db <= kChange_db) continue;
    pattern.warnings.push_back(
        fmt::format("{}: the {} cut has no rows between {:g} and {:g} deg, where it changes by {:.1f} dB: "
                    "amplitudes are interpolated there",
                    file, name, angles_deg[i], is_last ? angles_deg.front() : next_deg, change_db));
  }
}

}  // namespace

AntennaPtr antennaOf(const std::string& file, const PatternFile& pattern, double gain_dbi,
                     std::vector<std::string>& warnings) {
  if (std::isnan(gain_dbi)) {
    if (!pattern.gain_dbi) {
      throw Error(ErrorCode::bad_input, {file, 0, 0},
                  fmt::format("the {} has no gain; gain_dbi must be given with the file", pattern.format));
    }
    gain_dbi = *pattern.gain_dbi;
    if (!pattern.gain_warning.empty()) warnings.push_back(pattern.gain_warning);
  }
  requireGain(gain_dbi);
  AntennaPtr antenna = makeGridAntenna(pattern.nodes, pattern.amplitudes, gain_dbi, pattern.name);
  warnings.insert(warnings.end(), pattern.warnings.begin(), pattern.warnings.end());
  addWidthContradiction(warnings, file, "azimuth", pattern.stated_az_deg, antenna->beamwidth_az_deg);
  addWidthContradiction(warnings, file, "elevation", pattern.stated_el_deg, antenna->beamwidth_el_deg);
  return antenna;
}

AntennaPtr readAntenna(const std::string& file, double gain_dbi, StatedBand* band) {
  std::vector<std::string> warnings;
  const PatternFile pattern = readPatternFile(file);
  if (band != nullptr) *band = pattern.stated_band;
  AntennaPtr antenna = antennaOf(file, pattern, gain_dbi, warnings);
  for (const std::string& warning : warnings) logWarning(warning);
  return antenna;
}

void fillFromCuts(const std::string& file, const MeasuredCut& horizontal, const MeasuredCut& vertical,
                  PatternFile& pattern) {
  addHoles(file, "horizontal", horizontal, pattern);
  addHoles(file, "vertical", vertical, pattern);
  const double middle_deg = azimuthAhead(file, horizontal, vertical, pattern);
  pattern.nodes = gridNodes(horizontal.angles_deg(), vertical.angles_deg());
  std::vector<double> horizontal_db;
  for (const double azimuth_deg : pattern.nodes.azimuths_deg)
    horizontal_db.push_back(horizontal.attenuationAt_db(azimuth_deg));
  const double ahead_db = horizontal.attenuationAt_db(middle_deg);
  const double behind_db = horizontal.attenuationAt_db(middle_deg + 180);
  for (const double elevation_deg : pattern.nodes.elevations_deg) {
    const double front_db = vertical.attenuationAt_db(-elevation_deg) - ahead_db;
    const double back_db = vertical.attenuationAt_db(180 + elevation_deg) - behind_db;
    for (std::size_t i = 0; i < horizontal_db.size(); ++i) {
      const double w = std::abs(std::remainder(pattern.nodes.azimuths_deg[i] - middle_deg, 360.0)) / 180;
      const double attenuation_db = horizontal_db[i] + (1 - w) * front_db + w * back_db;
      pattern.amplitudes.push_back(static_cast<float>(amplitudeOfAttenuation(std::max(attenuation_db, 0.0))));
    }
  }
}

double peakAngle_deg(const MeasuredCut& cut) {
  return *std::max_element(cut.angles_deg().begin(), cut.angles_deg().end(),
                           [&](double a, double b) { return cut.amplitudeAt(a) < cut.amplitudeAt(b); });
}

void noteIgnored(PatternFile& pattern, const char* what, const std::vector<std::string>& ignored) {
  constexpr std::size_t kMaxNames = 8;
  if (ignored.empty()) return;
  const auto end = ignored.begin() + static_cast<std::ptrdiff_t>(std::min(ignored.size(), kMaxNames));
  pattern.notes.push_back(fmt::format("ignored: {} {} ({}{})", ignored.size(), what,
                                      fmt::join(ignored.begin(), end, ", "),
                                      ignored.size() > kMaxNames ? ", ..." : ""));
}

}  // namespace emscape::scenario
