#include "interop/importing/held_beams.h"

#include <algorithm>
#include <cmath>

#include "emscape/base/units.h"
#include "interop/dis/orientation.h"

namespace emscape::interop {
namespace {

constexpr double kStep_s = 1;
constexpr double kMaxSteps = 2000;

/// Heights above the sea stand for those above the ellipsoid: the geoid below both objects is nearly the
/// same.
Vec3d spotOf(const PoseSample& pose) {
  return toEcef({pose.latitude_deg, pose.longitude_deg, pose.height_msl_m});
}

/// The heading of an object that tells none is along its track.
double courseAt_deg(const RecordedObject& object, double t_s) {
  const PoseSample a = poseAt(object, t_s - 0.5), b = poseAt(object, t_s + 0.5);
  return radToDeg(
      geodesicInverse(a.latitude_deg, a.longitude_deg, b.latitude_deg, b.longitude_deg).azimuth_rad);
}

}  // namespace

RelativeDirection directionAt(const RecordedObject& from, const RecordedObject& to, double t_s) {
  const PoseSample pose = poseAt(from, t_s);
  const bool is_told = !std::isnan(pose.heading_deg);
  const dis::LocalAttitude attitude{is_told ? pose.heading_deg : courseAt_deg(from, t_s),
                                    is_told ? pose.pitch_deg : 0, is_told ? pose.roll_deg : 0};
  const dis::BodyAxes axes = dis::axesOf(attitude, pose.latitude_deg, pose.longitude_deg);
  const Vec3d towards = axes.toBody(spotOf(poseAt(to, t_s)) - spotOf(pose));
  return {radToDeg(std::atan2(towards.y, towards.x)),
          radToDeg(std::atan2(-towards.z, std::hypot(towards.x, towards.y)))};
}

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
