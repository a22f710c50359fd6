#include "emfield/link/path_clutter.h"

#include <algorithm>

#include "emfield/columns/station.h"

namespace emscape::emfield {

PathClutter::PathClutter(const scenario::Snapshot& snapshot, int radar, double range_m,
                         const scenario::Terrain* terrain)
    : range_m_(std::max(range_m, static_cast<double>(kMinDistance_m))) {
  const scenario::Scenario& scenario = *snapshot.scenario;
  const scenario::EmitterState& state = snapshot.emitters[static_cast<std::size_t>(radar)];
  const auto task = clutterMapTask(scenario, scenario.emitters[static_cast<std::size_t>(radar)],
                                   makeStation(state.position, state.height_msl_m, scenario.atmosphere));
  if (!task) return;
  task_ = *task;
  // Cells beyond the point's range cell do not affect it, but by echoes of later trips.
  const EchoTrips& trips = task_.grid.trips;
  const double farthest_m = trips.count > 1 ? std::max(range_m_, static_cast<double>(trips.end_m)) : range_m_;
  task_.grid.ranges = static_cast<int>(farthest_m / static_cast<double>(task_.grid.step_m)) + 2 +
                      task_.grid.steps_of_cell / 2;
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
  return {mix(&ClutterCell::echo), mix(&ClutterCell::sine)};
}

float PathClutter::toNoise(const ClutterTask& task, const EmitterBeam& beam, const Aim& aim) const {
  return onPattern(beam.pattern, [&](auto kind) {
    return clutterToNoise<kind>(task, *this, task_.grid.trips, beam, aim, static_cast<float>(range_m_));
  });
}

}  // namespace emscape::emfield
