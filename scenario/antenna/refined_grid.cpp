#include "scenario/antenna/refined_grid.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scenario/antenna/pattern.h"

namespace emscape::scenario {

RefinedAxis::RefinedAxis(int half_span_deg, double coarse_step_deg, const Zones& zones)
    : half_span_(half_span_deg * kUnitsPerDegree),
      fine_(std::max(1, static_cast<int>(zones.step_deg * kUnitsPerDegree + 1e-9))) {
  const int coarse = std::max(1, static_cast<int>(coarse_step_deg * kUnitsPerDegree / fine_ + 1e-9)) * fine_;
  nodes_ = {-half_span_, half_span_};
  for (int unit = half_span_ / coarse * -coarse; unit <= half_span_; unit += coarse) nodes_.push_back(unit);
  const bool is_closed = half_span_deg == 180;
  for (const double middle_deg : zones.middles_deg) {
    const double at_deg = is_closed ? std::remainder(middle_deg, 360) : middle_deg;
    const int first = static_cast<int>(std::ceil((at_deg - zones.half_width_deg) * kUnitsPerDegree / fine_));
    const int last = static_cast<int>(std::floor((at_deg + zones.half_width_deg) * kUnitsPerDegree / fine_));
    for (int n = first; n <= last; ++n) {
      int unit = n * fine_;
      if (is_closed && std::abs(unit) > half_span_) unit -= std::copysign(2 * half_span_, unit);
      if (std::abs(unit) <= half_span_) nodes_.push_back(unit);
    }
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
}

std::vector<float> RefinedAxis::positions() const {
  std::vector<float> positions;
  positions.reserve(static_cast<std::size_t>(2 * half_span_) + 1);
  for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
    const int length = nodes_[i + 1] - nodes_[i];
    for (int n = 0; n < length; ++n) positions.push_back(static_cast<float>(double(i) + double(n) / length));
  }
  positions.push_back(static_cast<float>(nodes_.size() - 1));
  return positions;
}

RefinedGridAntenna::RefinedGridAntenna(const RefinedAxis& azimuths, const RefinedAxis& elevations,
                                       std::vector<float> amplitudes, float side_lobe_amplitude)
    : azimuth_positions_(azimuths.positions()),
      elevation_positions_(elevations.positions()),
      amplitudes_(std::move(amplitudes)),
      columns_(azimuths.count()),
      rows_(elevations.count()),
      side_lobe_amplitude_(side_lobe_amplitude) {}

PatternView RefinedGridAntenna::view() const {
  PatternView view;
  view.kind = PatternKind::refined_grid;
  view.side_lobe_amplitude = side_lobe_amplitude_;
  view.azimuth_table = azimuth_positions_.data();
  view.elevation_table = elevation_positions_.data();
  view.azimuth_count = static_cast<int>(azimuth_positions_.size());
  view.elevation_count = static_cast<int>(elevation_positions_.size());
  view.grid_table = amplitudes_.data();
  view.columns = columns_;
  view.rows = rows_;
  return view;
}

double RefinedGridAntenna::signedAmplitudeTowards(const Vec3d& direction, double, double) const {
  return double(patternAmplitude(view(), vecCast<float>(direction), 0, 0));
}

}  // namespace emscape::scenario
