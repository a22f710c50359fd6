#include "interop/importing/held_beams.h"

#include <algorithm>

#include "recording/beams/directions.h"

namespace emscape::interop {
namespace {

constexpr double kStep_s = 1;
constexpr double kMaxSteps = 2000;

}  // namespace

std::vector<BeamState> withDirections(const RecordedBeam& beam, const std::vector<RecordedObject>& objects) {
  const RecordedObject& carrier = objects[beam.object];
  std::vector<BeamState> states;
  for (std::size_t i = 0; i < beam.states.size(); ++i) {
    BeamState state = beam.states[i];
    if (state.target == kNoTarget || state.target == beam.object || !state.is_on) {
      states.push_back(state);
      continue;
    }
    const RecordedObject& target = objects[state.target];
    const double last_s = std::max(carrier.poses.back().t_s, target.poses.back().t_s);
    const double end_s =
        i + 1 < beam.states.size() ? beam.states[i + 1].t_s : std::max(last_s, state.t_s + kStep_s);
    const double step_s = std::max(kStep_s, (end_s - state.t_s) / kMaxSteps);
    state.azimuth_half_sweep_deg = state.elevation_half_sweep_deg = 0;
    state.beamwidth_az_deg = state.beamwidth_el_deg = kUnknown;
    for (double t_s = state.t_s; t_s < end_s; t_s += step_s) {
      // The direction of the middle of the step, so that the error is that of half a step.
      const RelativeDirection direction = directionAt(carrier, target, std::min(t_s + step_s / 2, end_s));
      state.t_s = t_s;
      state.azimuth_deg = direction.azimuth_deg;
      state.elevation_deg = direction.elevation_deg;
      states.push_back(state);
    }
  }
  return states;
}

}  // namespace emscape::interop
