#include "scenario/antenna/sphere.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "emscape/base/units.h"

namespace emscape::scenario {
namespace {

std::vector<double> sortedOnce(std::vector<double> angles_deg) {
  std::sort(angles_deg.begin(), angles_deg.end());
  angles_deg.erase(std::unique(angles_deg.begin(), angles_deg.end()), angles_deg.end());
  return angles_deg;
}

/// Ascending angles of a measurement that may leave a part of the circle or of the range out.
class PartialAxis {
 public:
  PartialAxis(std::vector<double> angles_deg, bool closes)
      : angles_deg_(sortedOnce(std::move(angles_deg))), closes_(closes) {}

  const std::vector<double>& angles_deg() const { return angles_deg_; }

  /// Neighbours of an angle. @return false where nothing was measured
  bool locate(double angle_deg, AxisSample& sample) const {
    const auto next = std::upper_bound(angles_deg_.begin(), angles_deg_.end(), angle_deg + kRounding_deg);
    const std::size_t count = angles_deg_.size();
    if (next != angles_deg_.begin() && angle_deg - *(next - 1) <= kRounding_deg) {
      sample.below = sample.above = static_cast<std::size_t>(next - angles_deg_.begin()) - 1;
      sample.fraction = 0;
      return true;
    }
    const bool is_inside = next != angles_deg_.begin() && next != angles_deg_.end();
    if (!is_inside && !closes_) {
      const bool is_before = next == angles_deg_.begin();
      const double end_deg = is_before ? angles_deg_.front() : angles_deg_.back();
      if (std::abs(angle_deg - end_deg) > margin_deg()) return false;
      sample.below = sample.above = is_before ? 0 : count - 1;
      sample.fraction = 0;
      return true;
    }
    sample.above = static_cast<std::size_t>(next - angles_deg_.begin()) % count;
    sample.below = (sample.above + count - 1) % count;
    const auto turn = [](double from, double to) { return to - from + (to < from ? 360 : 0); };
    const double gap_deg = turn(angles_deg_[sample.below], angles_deg_[sample.above]);
    if (closes_ && (count == 1 || gap_deg > MeasuredAxis::kMaxGap_deg)) return false;
    sample.fraction = turn(angles_deg_[sample.below], angle_deg) / gap_deg;
    return true;
  }

  /// What the ends may lack, as rows in the middle of their intervals do.
  double margin_deg() const { return angles_deg_.size() > 1 ? 1.5 * step_deg() : 0; }

  /// Smallest distance (deg) of neighbours; 360: there is one angle.
  double step_deg() const {
    double step = 360;
    for (std::size_t i = 1; i < angles_deg_.size(); ++i)
      step = std::min(step, angles_deg_[i] - angles_deg_[i - 1]);
    return step;
  }

 private:
  static constexpr double kRounding_deg = 1e-6;
  std::vector<double> angles_deg_;
  bool closes_;
};

/// Amplitudes on a grid of two angles.
class SphereTable {
 public:
  SphereTable(const std::vector<SphereRow>& rows, const SphereRange& range, const std::string& file)
      : first_(anglesOf(rows, &SphereRow::first_deg), true),
        second_(anglesOf(rows, &SphereRow::second_deg), false),
        outside_(amplitudeOfAttenuation(range.max_db - range.min_db)) {
    constexpr double kSame_db = 0.05;  // 0 and 360 degrees are written with rounding
    std::map<std::pair<double, double>, const SphereRow*> by_angles;
    for (const SphereRow& row : rows) {
      const auto [known, is_new] = by_angles.emplace(std::pair(row.second_deg, row.first_deg), &row);
      if (is_new || std::abs(known->second->gain_db - row.gain_db) <= kSame_db) continue;
      throw Error(
          ErrorCode::bad_input, {file, row.line, 1},
          fmt::format("the direction of line {} occurs a second time, with {:g} dB instead of {:g} dB",
                      known->second->line, row.gain_db, known->second->gain_db));
    }
    for (const double second_deg : second_.angles_deg()) {
      for (const double first_deg : first_.angles_deg()) {
        const auto found = by_angles.find({second_deg, first_deg});
        if (found == by_angles.end()) {
          throw Error(ErrorCode::bad_input, {file, 0, 0},
                      fmt::format("the rows are not a full grid: there is none for {:g}, {:g} deg", first_deg,
                                  second_deg));
        }
        amplitudes_.push_back(amplitudeOfAttenuation(range.max_db - found->second->gain_db));
      }
    }
  }

  const PartialAxis& first() const { return first_; }
  const PartialAxis& second() const { return second_; }

  double at(double first_deg, double second_deg) const {
    AxisSample a, e;
    const double wrapped_deg = MeasuredAxis::normalized(AxisKind::circle, first_deg);
    if (!first_.locate(wrapped_deg, a) || !second_.locate(second_deg, e)) return outside_;
    const std::size_t count = first_.angles_deg().size();
    const auto along = [&](std::size_t row) {
      const double* const values = &amplitudes_[row * count];
      return values[a.below] + a.fraction * (values[a.above] - values[a.below]);
    };
    return along(e.below) + e.fraction * (along(e.above) - along(e.below));
  }

 private:
  static std::vector<double> anglesOf(const std::vector<SphereRow>& rows, double SphereRow::*angle) {
    std::vector<double> angles_deg;
    angles_deg.reserve(rows.size());
    for (const SphereRow& row : rows) angles_deg.push_back(row.*angle);
    return angles_deg;
  }

  PartialAxis first_, second_;
  double outside_;
  std::vector<double> amplitudes_;
};

/// Largest angle (deg) between neighbours of a circle.
double largestGap_deg(const std::vector<double>& angles_deg) {
  double gap_deg = angles_deg.front() + 360 - angles_deg.back();
  for (std::size_t i = 1; i < angles_deg.size(); ++i)
    gap_deg = std::max(gap_deg, angles_deg[i] - angles_deg[i - 1]);
  return gap_deg;
}

void warnOfMissingPart(const SphereTable& table, const SphereRange& range, double lowest_deg,
                       double highest_deg, const std::string& file, PatternFile& pattern) {
  const std::vector<double>&first = table.first().angles_deg(), &second = table.second().angles_deg();
  const double margin_deg = table.second().margin_deg();
  const bool covers = largestGap_deg(first) <= MeasuredAxis::kMaxGap_deg &&
                      second.front() - lowest_deg <= margin_deg && highest_deg - second.back() <= margin_deg;
  if (covers) return;
  pattern.warnings.push_back(
      fmt::format("{}: the rows cover {:g} to {:g} deg in {} and {:g} to {:g} deg in {}: elsewhere their "
                  "smallest gain is used, {:.1f} dB below the maximum",
                  file, first.front(), first.back(), lowest_deg < 0 ? "azimuth" : "phi", second.front(),
                  second.back(), lowest_deg < 0 ? "elevation" : "theta", range.max_db - range.min_db));
}

/// Angles from -limit to limit in steps of about step_deg that divide the limit.
std::vector<double> evenAngles(double limit_deg, double step_deg) {
  const int half = static_cast<int>(std::ceil(limit_deg / step_deg));
  std::vector<double> angles_deg;
  for (int i = -half; i <= half; ++i) angles_deg.push_back(limit_deg * i / half);
  return angles_deg;
}

}  // namespace

SphereRange fillFromSphere(SphereAngles angles, std::vector<SphereRow> rows, const std::string& file,
                           PatternFile& pattern) {
  if (rows.empty()) throw Error(ErrorCode::bad_input, {file, 0, 0}, "the pattern has no rows");
  const bool is_from_boresight = angles == SphereAngles::theta_from_boresight;
  SphereRange range{rows.front().gain_db, rows.front().gain_db};
  for (SphereRow& row : rows) {
    if (angles != SphereAngles::azimuth_elevation && row.second_deg < 0) {
      row.first_deg += 180;
      row.second_deg = -row.second_deg;
    }
    if (angles == SphereAngles::theta_from_zenith) {
      row.first_deg = -row.first_deg;
      row.second_deg = 90 - row.second_deg;
    }
    row.first_deg = MeasuredAxis::normalized(AxisKind::circle, row.first_deg);
    row.second_deg = MeasuredAxis::normalized(AxisKind::elevation, row.second_deg);
    range.max_db = std::max(range.max_db, row.gain_db);
    range.min_db = std::min(range.min_db, row.gain_db);
  }
  const SphereTable table(rows, range, file);
  warnOfMissingPart(table, range, is_from_boresight ? 0 : -90, is_from_boresight ? 180 : 90, file, pattern);
  std::vector<double> azimuths_deg = table.first().angles_deg(), elevations_deg = table.second().angles_deg();
  if (is_from_boresight) {
    const double step_deg = std::clamp(table.second().step_deg(), 0.25, 2.0);
    azimuths_deg = evenAngles(180, step_deg);
    elevations_deg = evenAngles(90, step_deg);
  } else {
    elevations_deg.insert(elevations_deg.end(), {-90, 90});
    elevations_deg = sortedOnce(std::move(elevations_deg));
    if (azimuths_deg.size() == 1) azimuths_deg = evenAngles(180, 1);
  }
  pattern.nodes = gridNodes(azimuths_deg, elevations_deg);
  for (const double elevation_deg : pattern.nodes.elevations_deg) {
    for (const double azimuth_deg : pattern.nodes.azimuths_deg) {
      double first_deg = azimuth_deg, second_deg = elevation_deg;
      if (is_from_boresight) {
        const double azimuth_rad = degToRad(azimuth_deg), elevation_rad = degToRad(elevation_deg);
        const double forward = std::cos(elevation_rad) * std::cos(azimuth_rad);
        const double left = -std::cos(elevation_rad) * std::sin(azimuth_rad), up = std::sin(elevation_rad);
        first_deg = radToDeg(std::atan2(up, left));
        second_deg = radToDeg(std::atan2(std::hypot(left, up), forward));
      }
      pattern.amplitudes.push_back(static_cast<float>(table.at(first_deg, second_deg)));
    }
  }
  return range;
}

}  // namespace emscape::scenario
