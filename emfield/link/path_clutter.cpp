#include "emfield/link/path_clutter.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "emfield/columns/station.h"

namespace emscape::emfield {

using scenario::PatternKind;

PathClutter::PathClutter(const scenario::Snapshot& snapshot, int radar, double range_m,
                         const scenario::Terrain* terrain)
    : range_m_(std::max(range_m, static_cast<double>(kMinDistance_m))) {
  const scenario::Scenario& scenario = *snapshot.scenario;
  const scenario::EmitterState& state = snapshot.emitters[static_cast<std::size_t>(radar)];
  const auto task = clutterMapTask(scenario, scenario.emitters[static_cast<std::size_t>(radar)],
                                   makeStation(state.position, state.height_msl_m, scenario.atmosphere));
  if (!task) return;
  task_ = *task;
  // Cells beyond the point do not affect those before it.
  task_.grid.ranges = static_cast<int>(range_m_ / static_cast<double>(task_.grid.step_m)) + 2;
  post_ranges_m_ = clutterPostRanges(task_.grid, postSpacing_m(terrain));
  task_.ground = groundPosts(terrain, post_ranges_m_);
}

const std::vector<ClutterCell>& PathClutter::row(int azimuth) const {
  std::vector<ClutterCell>& cells = rows_[azimuth];
  if (cells.empty()) {
    cells.resize(static_cast<std::size_t>(task_.grid.ranges));
    task_(azimuth, cells.data());
  }
  return cells;
}

ClutterCell PathClutter::cellAt(float azimuth_rad, float range_m) const {
  const ClutterMapView shape = clutterMapView(task_.grid, nullptr);
  const ClutterNeighbours rows = rowsBeside(azimuth_rad, shape.azimuths, shape.azimuths_per_rad);
  const ClutterNeighbours columns = cellsBeside(range_m, shape.ranges, shape.cells_per_m);
  const auto mix = [&](float ClutterCell::*value) {
    const std::vector<ClutterCell>&near_row = row(rows.first), &far_row = row(rows.second);
    return mixed(near_row[columns.first].*value, near_row[columns.second].*value,
                 far_row[columns.first].*value, far_row[columns.second].*value, rows.weight, columns.weight);
  };
  return {mix(&ClutterCell::echo), mix(&ClutterCell::echo_times_sine)};
}

float PathClutter::toNoise(const ClutterTask& task, const EmitterBeam& beam, const Aim& aim) const {
  const auto of = [&](auto kind) {
    return clutterToNoise<decltype(kind)::value>(task, *this, beam, aim, static_cast<float>(range_m_));
  };
  switch (beam.pattern.kind) {
    case PatternKind::gaussian:
      return of(std::integral_constant<PatternKind, PatternKind::gaussian>{});
    case PatternKind::separable:
      return of(std::integral_constant<PatternKind, PatternKind::separable>{});
    case PatternKind::phased_array:
      return of(std::integral_constant<PatternKind, PatternKind::phased_array>{});
    case PatternKind::grid:
      return of(std::integral_constant<PatternKind, PatternKind::grid>{});
    case PatternKind::isotropic:
      break;
  }
  return of(std::integral_constant<PatternKind, PatternKind::isotropic>{});
}

}  // namespace emscape::emfield
