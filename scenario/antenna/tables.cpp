#include "scenario/antenna/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/math/device_math.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"

namespace emscape::scenario {
namespace {

/// A number of intervals, rounded up to an even number so that the middle is an entry.
int evenIntervals(double intervals) {
  return 2 * static_cast<int>(std::ceil(std::clamp(intervals, 2.0, double(kMaxIntervals)) / 2));
}

ShapeTable sample(Shape shape, double half_span, int intervals) {
  ShapeTable table{std::move(shape), half_span, {}};
  table.values.reserve(static_cast<std::size_t>(intervals) + 1);
  const int middle = intervals / 2;
  for (int i = -middle; i <= middle; ++i) {
    table.values.push_back(static_cast<float>(table.shape(half_span * i / middle)));
  }
  return table;
}

}  // namespace

ShapeTable tabulate(Shape shape, double half_span, double largest_step) {
  return sample(std::move(shape), half_span, evenIntervals(2 * half_span / largest_step));
}

ShapeTable tabulate(Shape shape, double half_span, const std::vector<double>& angles_deg) {
  return sample(std::move(shape), half_span,
                intervalsThatMeet(angles_deg, radToDeg(2 * half_span), kMaxIntervals));
}

int intervalsThatMeet(const std::vector<double>& angles_deg, double span_deg, int most) {
  constexpr double kUnitsPerDegree = 1e4;
  constexpr double kStepsPerSpacing = 8;
  const auto half_span = std::llround(span_deg / 2 * kUnitsPerDegree);
  long long step = half_span;
  double closest_deg = span_deg;
  bool whole = true;
  for (std::size_t i = 0; i < angles_deg.size(); ++i) {
    const double units = angles_deg[i] * kUnitsPerDegree;
    whole = whole && std::abs(units - std::round(units)) < 1e-4;
    step = std::gcd(step, std::llround(units));
    if (i > 0) closest_deg = std::min(closest_deg, angles_deg[i] - angles_deg[i - 1]);
  }
  if (whole && 2 * (half_span / step) <= most) return static_cast<int>(2 * (half_span / step));
  return std::min(evenIntervals(kStepsPerSpacing * span_deg / closest_deg), most);
}

double halfPowerWidth(const std::vector<float>& values, double half_span, bool closed) {
  const int intervals = static_cast<int>(values.size()) - 1;
  const auto amplitude = [&](int i) {
    return std::abs(
        double(values[static_cast<std::size_t>(closed ? ((i % intervals) + intervals) % intervals : i)]));
  };
  int peak = 0;
  for (int i = 1; i <= intervals; ++i) {
    if (amplitude(i) > amplitude(peak)) peak = i;
  }
  const double half_power = amplitude(peak) * std::sqrt(0.5);
  // Intervals from the peak to the crossing on one side; if there is none, to the end of the table, or the
  // whole circle.
  const auto walk = [&](int direction) -> double {
    const int limit = closed ? intervals : (direction > 0 ? intervals - peak : peak);
    for (int n = 1; n <= limit; ++n) {
      const double inner = amplitude(peak + direction * (n - 1));
      const double outer = amplitude(peak + direction * n);
      if (outer < half_power) return n - 1 + (inner - half_power) / (inner - outer);
    }
    return limit;
  };
  return std::min(walk(-1) + walk(1), double(intervals)) * 2 * half_span / intervals;
}

Angles patternAngles(const Vec3d& direction) {
  return {std::atan2(direction.y, direction.x),
          std::atan2(direction.z, std::hypot(direction.x, direction.y))};
}

float lobeTangent(double edge_azimuth_rad) {
  // Near a right angle the tangent is too steep to be useful; the margin covers its rounding.
  constexpr double kWidest_rad = 1.4, kMargin = 1e-4;
  return edge_azimuth_rad < kWidest_rad
             ? static_cast<float>(std::tan(edge_azimuth_rad) * (1 + kMargin) + kMargin)
             : 0.0f;
}

SeparableAntenna::SeparableAntenna(ShapeTable azimuth, ShapeTable elevation, double side_lobe_amplitude)
    : azimuth_(std::move(azimuth)),
      elevation_(std::move(elevation)),
      side_lobe_amplitude_(side_lobe_amplitude) {
  double highest = 0;
  for (float amplitude : elevation_.values) highest = std::max(highest, std::abs(double(amplitude)));
  const int middle = azimuth_.count() / 2;
  int edge = middle;
  const auto isLow = [&](int i) {
    return std::abs(double(azimuth_.values[i])) * highest < side_lobe_amplitude_;
  };
  while (edge > 0 && isLow(middle - edge) && isLow(middle + edge)) --edge;
  lobe_tangent_ = lobeTangent((edge + 1) * azimuth_.half_span / middle);
}

PatternView SeparableAntenna::view() const {
  PatternView view;
  view.kind = PatternKind::separable;
  view.side_lobe_amplitude = static_cast<float>(side_lobe_amplitude_);
  view.lobe_tangent = lobe_tangent_;
  view.azimuth_table = azimuth_.values.data();
  view.elevation_table = elevation_.values.data();
  view.azimuth_count = azimuth_.count();
  view.elevation_count = elevation_.count();
  return view;
}

double SeparableAntenna::signedAmplitudeTowards(const Vec3d& direction, double, double) const {
  const Angles angles = patternAngles(direction);
  const double product = azimuth_.shape(angles.azimuth_rad) * elevation_.shape(angles.elevation_rad);
  return std::copysign(std::max(std::abs(product), side_lobe_amplitude_), product);
}

GridAntenna::GridAntenna(std::vector<float> amplitudes, int azimuth_count, int elevation_count,
                         float side_lobe_amplitude)
    : amplitudes_(std::move(amplitudes)),
      azimuth_count_(azimuth_count),
      elevation_count_(elevation_count),
      side_lobe_amplitude_(side_lobe_amplitude) {}

PatternView GridAntenna::view() const {
  PatternView view;
  view.kind = PatternKind::grid;
  view.side_lobe_amplitude = side_lobe_amplitude_;
  view.grid_table = amplitudes_.data();
  view.columns = azimuth_count_;
  view.rows = elevation_count_;
  return view;
}

double GridAntenna::signedAmplitudeTowards(const Vec3d& direction, double, double) const {
  const Angles angles = patternAngles(direction);
  const double x = (angles.azimuth_rad / (2 * kPi) + 0.5) * (azimuth_count_ - 1);
  const double y = (angles.elevation_rad / kPi + 0.5) * (elevation_count_ - 1);
  const int column = std::clamp(static_cast<int>(x), 0, azimuth_count_ - 2);
  const int row = std::clamp(static_cast<int>(y), 0, elevation_count_ - 2);
  const auto entry = [&](int i, int j) {
    return double(amplitudes_[static_cast<std::size_t>(row + j) * azimuth_count_ + column + i]);
  };
  const double value =
      lerp(lerp(entry(0, 0), entry(1, 0), x - column), lerp(entry(0, 1), entry(1, 1), x - column), y - row);
  return std::copysign(std::max(std::abs(value), static_cast<double>(side_lobe_amplitude_)), value);
}

GridNodes gridNodes(const std::vector<double>& azimuths_deg, const std::vector<double>& elevations_deg) {
  const auto nodes = [](double span_deg, int intervals) {
    std::vector<double> angles;
    for (int i = 0; i <= intervals; ++i) angles.push_back(span_deg * (double(i) / intervals - 0.5));
    return angles;
  };
  return {nodes(360, intervalsThatMeet(azimuths_deg, 360, kMaxGridIntervals)),
          nodes(180, intervalsThatMeet(elevations_deg, 180, kMaxGridIntervals / 2))};
}

AntennaPtr makeGridAntenna(const GridNodes& nodes, std::vector<float> amplitudes, double gain_dbi,
                           const std::string& name) {
  const std::size_t columns = nodes.azimuths_deg.size(), rows = nodes.elevations_deg.size();
  const auto peak =
      static_cast<std::size_t>(std::max_element(amplitudes.begin(), amplitudes.end()) - amplitudes.begin());
  std::vector<float> azimuth_cut, elevation_cut;
  for (std::size_t i = 0; i < columns; ++i) azimuth_cut.push_back(amplitudes[peak / columns * columns + i]);
  for (std::size_t j = 0; j < rows; ++j) elevation_cut.push_back(amplitudes[j * columns + peak % columns]);
  return describedAntenna(
      std::make_shared<GridAntenna>(std::move(amplitudes), static_cast<int>(columns), static_cast<int>(rows)),
      gain_dbi, halfPowerWidth(azimuth_cut, 180, true), halfPowerWidth(elevation_cut, 90, false), name);
}

AntennaPtr describedAntenna(const std::shared_ptr<Antenna>& antenna, double gain_dbi, double beamwidth_az_deg,
                            double beamwidth_el_deg, const std::string& name) {
  antenna->gain_dbi = gain_dbi;
  antenna->beamwidth_az_deg = beamwidth_az_deg;
  antenna->beamwidth_el_deg = beamwidth_el_deg;
  antenna->description =
      fmt::format("{}, {:.4g} x {:.4g} deg, {:.2f} dBi", name, beamwidth_az_deg, beamwidth_el_deg, gain_dbi);
  return antenna;
}

void requireGain(double gain_dbi) {
  requireWithin("gain_dbi", gain_dbi, -kMaxGain_dbi, kMaxGain_dbi, "dBi");
}

void requireWithin(const char* name, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return;
  const std::string space = *unit == '\0' ? "" : " ";
  throw Error(ErrorCode::bad_input, fmt::format("{} is {}{}{}; allowed are {} to {}{}{}", name, value, space,
                                                unit, low, high, space, unit));
}

}  // namespace emscape::scenario
