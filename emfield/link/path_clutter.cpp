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

const std::vector<ClutterCell>& PathClutter::alongAzimuth(int azimuth) const {
  std::vector<ClutterCell>& cells = along_[azimuth];
  if (cells.empty()) {
    cells.resize(static_cast<std::size_t>(task_.grid.ranges));
    task_(azimuth, cells.data());
  }
  return cells;
}

ClutterCell PathClutter::ofBeam(int row, int cell) const {
  const PowerBeside& power = task_.power;
  const int azimuths = task_.grid.azimuths;
  ClutterCell sum;
  for (int n = 0; n <= 2 * power.beside; ++n) {
    const int azimuth = (row + n - power.beside + azimuths) % azimuths;
    sum.add(alongAzimuth(azimuth)[static_cast<std::size_t>(cell)], power.parts[n]);
  }
  return sum;
}

ClutterCell PathClutter::cellAt(float azimuth_rad, float range_m) const {
  const ClutterMapView shape = clutterMapView(task_.grid, nullptr);
  const ClutterNeighbours rows = rowsBeside(azimuth_rad, shape.azimuths, shape.azimuths_per_rad);
  const ClutterNeighbours columns = cellsBeside(range_m, shape.ranges, shape.cells_per_m);
  return mixed(ofBeam(rows.first, columns.first), ofBeam(rows.first, columns.second),
               ofBeam(rows.second, columns.first), ofBeam(rows.second, columns.second), rows.weight,
               columns.weight);
}

float PathClutter::toNoise(const ClutterTask& task, const EmitterBeam& beam, const Aim& aim) const {
  return onPattern(beam.pattern, [&](auto kind) {
    return clutterToNoise<kind>(task, *this, task_.grid.trips, beam, aim, static_cast<float>(range_m_));
  });
}

}  // namespace emscape::emfield
