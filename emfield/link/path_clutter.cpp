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
                      task_.grid.steps.of_cell / 2;
  steps = task_.grid.steps;
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
    const ClutterCell& along =
        alongAzimuth((row + n - power.beside + azimuths) % azimuths)[static_cast<std::size_t>(cell)];
    sum.echo += power.parts[n] * along.echo;
    sum.echo_sine += power.parts[n] * along.echo_sine;
  }
  return sum;
}

ClutterNeighbours PathClutter::rows(float azimuth_rad) const {
  return clutterMapView(task_.grid, nullptr).rows(azimuth_rad);
}

ClutterCell PathClutter::stepAt(const ClutterNeighbours& rows, float range_m, int step) const {
  const ClutterMapView shape = clutterMapView(task_.grid, nullptr);
  const TouchedStep touched = touchedStep(steps, range_m, shape.ranges, shape.cells_per_m, step);
  return stepBetween(ofBeam(rows.first, touched.cell), ofBeam(rows.second, touched.cell), rows.weight,
                     touched.part);
}

float PathClutter::toNoise(const ClutterTask& task, const EmitterBeam& beam, const Aim& aim) const {
  return onPattern(beam.pattern, [&](auto kind) {
    return clutterToNoise<kind>(task, *this, task_.grid.trips, beam, aim, static_cast<float>(range_m_));
  });
}

}  // namespace emscape::emfield
