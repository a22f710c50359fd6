#include "scenario/antenna/cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace emscape::scenario {

MeasuredAxis::MeasuredAxis(AxisKind kind, std::vector<double> angles_deg, const SourceLocation& file,
                           const char* what)
    : kind_(kind), angles_deg_(std::move(angles_deg)) {
  std::sort(angles_deg_.begin(), angles_deg_.end());
  angles_deg_.erase(std::unique(angles_deg_.begin(), angles_deg_.end()), angles_deg_.end());
  if (angles_deg_.empty()) throw Error(ErrorCode::bad_input, file, fmt::format("the {} has no rows", what));
  if (kind == AxisKind::elevation && (angles_deg_.front() > -90 || angles_deg_.back() < 90)) {
    throw Error(ErrorCode::bad_input, file,
                fmt::format("the {} runs from {} to {} deg; it must reach from -90 to 90 deg", what,
                            angles_deg_.front(), angles_deg_.back()));
  }
  const bool closes = kind == AxisKind::circle;
  for (std::size_t i = 0; i + (closes ? 0 : 1) < angles_deg_.size(); ++i) {
    const bool last = i + 1 == angles_deg_.size();
    const double next = last ? angles_deg_.front() + 360 : angles_deg_[i + 1];
    if (next - angles_deg_[i] > kMaxGap_deg) {
      throw Error(ErrorCode::bad_input, file,
                  fmt::format("the {} has no rows between {} and {} deg; gaps of up to {} deg are allowed",
                              what, angles_deg_[i], last ? angles_deg_.front() : next, kMaxGap_deg));
    }
  }
}

double MeasuredAxis::normalized(AxisKind kind, double angle_deg) {
  constexpr double kUnitsPerDegree = 1e6;
  const double rounded = std::round(angle_deg * kUnitsPerDegree) / kUnitsPerDegree;
  if (kind == AxisKind::elevation) return rounded;
  const double wrapped = std::round(std::remainder(rounded, 360.0) * kUnitsPerDegree) / kUnitsPerDegree;
  return wrapped == 180 ? -180 : wrapped;
}

std::size_t MeasuredAxis::indexOf(double normalized_deg) const {
  return static_cast<std::size_t>(std::lower_bound(angles_deg_.begin(), angles_deg_.end(), normalized_deg) -
                                  angles_deg_.begin());
}

AxisSample MeasuredAxis::locate(double angle_deg) const {
  const std::size_t count = angles_deg_.size();
  if (kind_ == AxisKind::circle) {
    const double angle = std::remainder(angle_deg, 360.0);
    const auto next = std::upper_bound(angles_deg_.begin(), angles_deg_.end(), angle);
    const std::size_t above = static_cast<std::size_t>(next - angles_deg_.begin()) % count;
    const std::size_t below = (above + count - 1) % count;
    const auto turn = [](double from, double to) { return to - from + (to < from ? 360 : 0); };
    return {below, above, turn(angles_deg_[below], angle) / turn(angles_deg_[below], angles_deg_[above])};
  }
  const auto next = std::upper_bound(angles_deg_.begin() + 1, angles_deg_.end() - 1, angle_deg);
  const auto above = static_cast<std::size_t>(next - angles_deg_.begin());
  const double fraction =
      (angle_deg - angles_deg_[above - 1]) / (angles_deg_[above] - angles_deg_[above - 1]);
  return {above - 1, above, std::clamp(fraction, 0.0, 1.0)};
}

namespace {

std::vector<double> anglesOf(const std::vector<CutRow>& rows) {
  std::vector<double> angles;
  angles.reserve(rows.size());
  for (const CutRow& row : rows) angles.push_back(row.angle_deg);
  return angles;
}

std::vector<CutRow> normalizedRows(AxisKind kind, std::vector<CutRow> rows) {
  for (CutRow& row : rows) row.angle_deg = MeasuredAxis::normalized(kind, row.angle_deg);
  return rows;
}

}  // namespace

MeasuredCut::MeasuredCut(AxisKind kind, std::vector<CutRow> rows, const SourceLocation& file,
                         const char* what)
    : axis_(kind, anglesOf(rows = normalizedRows(kind, rows)), file, what),
      amplitudes_(axis_.angles_deg().size(), -1.0) {
  for (const CutRow& row : rows) {
    double& amplitude = amplitudes_[axis_.indexOf(row.angle_deg)];
    const double of_row = amplitudeOfAttenuation(row.attenuation_db);
    if (amplitude >= 0 && amplitude != of_row) {
      throw Error(ErrorCode::bad_input, {file.file, row.line, row.column},
                  fmt::format("the {} has {} deg twice, with different attenuations", what, row.angle_deg));
    }
    amplitude = of_row;
  }
}

double MeasuredCut::amplitudeAt(double angle_deg) const {
  const AxisSample sample = axis_.locate(angle_deg);
  return amplitudes_[sample.below] +
         sample.fraction * (amplitudes_[sample.above] - amplitudes_[sample.below]);
}

double MeasuredCut::attenuationAt_db(double angle_deg) const {
  return -20 * std::log10(amplitudeAt(angle_deg));
}

double amplitudeOfAttenuation(double attenuation_db) {
  return std::pow(10.0, -attenuation_db / 20);
}

void requireMaximum(double smallest_attenuation_db, const SourceLocation& file, const char* what) {
  constexpr double kTolerance_db = 1;
  if (smallest_attenuation_db <= kTolerance_db) return;
  throw Error(
      ErrorCode::bad_input, file,
      fmt::format(
          "the smallest attenuation of the {} is {} dB; attenuations count from the maximum, so that one "
          "must be at most {} dB",
          what, smallest_attenuation_db, kTolerance_db));
}

}  // namespace emscape::scenario
