/// Antenna patterns of SPLAT!: relative field, 0 to 1, by azimuth (.az) and by elevation (.el).
///
/// The first line of .az is the angle (deg, clockwise) by which the pattern is turned; its rows are azimuths
/// clockwise. The first line of .el is the mechanical tilt (deg, downwards) and the azimuth of the tilt; its
/// rows are elevations counted downwards, -10 (above the horizon) to 90 (the nadir). The pattern is the
/// product of both.
///
/// @see SPLAT! manual, "Antenna radiation pattern parameters"
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

struct SplatFile {
  double turn_deg = 0;                            ///< of .az: clockwise; of .el: downwards
  double tilt_azimuth_deg = 0;                    ///< of .el
  std::vector<std::pair<double, double>> fields;  ///< angle (deg), relative field; ascending
};

SplatFile readSplatFile(const std::string& file, double lowest_deg, double highest_deg) {
  const TextLines text(file);
  SplatFile result;
  bool is_first = true;
  const auto fail = [&](const TextField& field, const std::string& message) {
    throw Error(ErrorCode::bad_input, text.location(field), message);
  };
  for (const TextField& whole : text.lines()) {
    // Comments begin with a semicolon.
    const TextField line =
        document::restOf({whole.text.substr(0, whole.text.find(';')), whole.line, whole.column}, 0);
    if (line.text.empty()) continue;
    const std::vector<TextField> words = document::wordsOf(line);
    const auto numberAt = [&](std::size_t i, double lowest, double highest, const char* what) {
      const std::optional<double> value = document::numberOrCommaIn(words[i].text);
      if (!value) fail(words[i], fmt::format("{} is '{}', not a number", what, words[i].text));
      if (*value < lowest || *value > highest)
        fail(words[i], fmt::format("{} is {}; allowed are {} to {}", what, *value, lowest, highest));
      return *value;
    };
    if (is_first && words.size() <= 2) {
      result.turn_deg = numberAt(0, -360, 360, "the first line's angle");
      if (words.size() == 2) result.tilt_azimuth_deg = numberAt(1, -360, 360, "the azimuth of the tilt");
      is_first = false;
      continue;
    }
    if (words.size() != 2)
      fail(line, fmt::format("'{}' is no angle and relative field", line.text.substr(0, 40)));
    result.fields.emplace_back(numberAt(0, lowest_deg, highest_deg, "the angle"),
                               numberAt(1, 0, 1.001, "the relative field"));
  }
  std::sort(result.fields.begin(), result.fields.end());
  if (result.fields.size() < 2)
    throw Error(ErrorCode::bad_input, {file, 0, 0}, "fewer than 2 rows of an angle and a relative field");
  return result;
}

double attenuationOfField(double field) {
  return field > 0 ? std::min(-20 * std::log10(std::min(field, 1.0)), kMaxAttenuation_db)
                   : kMaxAttenuation_db;
}

/// Linear between the rows, and that of the nearest row beyond them.
double fieldAt(const SplatFile& file, double angle_deg) {
  const auto& rows = file.fields;
  const auto next = std::upper_bound(rows.begin(), rows.end(), std::pair(angle_deg, HUGE_VAL));
  if (next == rows.begin()) return rows.front().second;
  if (next == rows.end()) return rows.back().second;
  const auto& [from_deg, from] = *(next - 1);
  const auto& [to_deg, to] = *next;
  return to_deg > from_deg ? from + (to - from) * (angle_deg - from_deg) / (to_deg - from_deg) : to;
}

MeasuredCut azimuthCut(const SplatFile& azimuth, const std::string& file) {
  std::vector<CutRow> rows;
  for (const auto& [angle_deg, field] : azimuth.fields)
    rows.push_back({angle_deg + azimuth.turn_deg, attenuationOfField(field), 0, 0});
  return {AxisKind::circle, std::move(rows), {file, 0, 0}, "pattern"};
}

}  // namespace

PatternFile readSplat(const std::string& azimuth_file, const std::string& elevation_file) {
  PatternFile pattern;
  pattern.format = "SPLAT! pattern";
  pattern.name = "SPLAT! pattern";
  SplatFile azimuth, elevation;
  std::optional<MeasuredCut> cut;
  std::vector<double> azimuths_deg{-180, -90, 0, 90}, elevations_deg{-90, 0, 90};
  if (azimuth_file.empty()) {
    pattern.notes.push_back("no .az file beside it: the same in all azimuths");
  } else {
    azimuth = readSplatFile(azimuth_file, -360, 360);
    cut.emplace(azimuthCut(azimuth, azimuth_file));
    azimuths_deg = cut->angles_deg();
    if (azimuth.turn_deg != 0) {
      pattern.notes.push_back(
          fmt::format("the azimuth pattern is turned by {:g} deg clockwise, as its first line "
                      "says",
                      azimuth.turn_deg));
    }
  }
  if (elevation_file.empty()) {
    pattern.notes.push_back("no .el file beside it: the same at all elevations");
  } else {
    elevation = readSplatFile(elevation_file, -90, 90);
    const double first_deg = elevation.fields.front().first, last_deg = elevation.fields.back().first;
    for (const auto& [below_deg, field] : elevation.fields) elevations_deg.push_back(-below_deg);
    std::sort(elevations_deg.begin(), elevations_deg.end());
    elevations_deg.erase(std::unique(elevations_deg.begin(), elevations_deg.end()), elevations_deg.end());
    if (first_deg > -90 || last_deg < 90) {
      pattern.warnings.push_back(
          fmt::format("{}: the elevations run from {:g} deg above the horizon to {:g} deg below it; beyond "
                      "them the field of the last row is used",
                      elevation_file, -first_deg, last_deg));
    }
    if (elevation.turn_deg != 0) {
      pattern.notes.push_back(fmt::format("the beam is tilted by {:g} deg downwards at azimuth {:g} deg",
                                          elevation.turn_deg, elevation.tilt_azimuth_deg));
      azimuths_deg = gridNodes(azimuths_deg, elevations_deg).azimuths_deg;
    }
  }
  pattern.nodes = gridNodes(azimuths_deg, elevations_deg);
  for (const double elevation_deg : pattern.nodes.elevations_deg) {
    for (const double azimuth_deg : pattern.nodes.azimuths_deg) {
      const double tilt_deg =
          elevation.turn_deg * std::cos(degToRad(azimuth_deg - elevation.tilt_azimuth_deg));
      const double of_elevation =
          elevation.fields.empty() ? 1 : fieldAt(elevation, -elevation_deg - tilt_deg);
      const double of_azimuth = cut ? cut->amplitudeAt(azimuth_deg) : 1;
      pattern.amplitudes.push_back(static_cast<float>(std::min(of_azimuth * of_elevation, 1.0)));
    }
  }
  return pattern;
}

}  // namespace emscape::scenario
