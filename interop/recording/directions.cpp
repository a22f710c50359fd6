#include "interop/recording/directions.h"

#include <cmath>
#include <set>

#include "emscape/base/units.h"
#include "interop/recording/samples.h"

namespace emscape::interop {
namespace {

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

RelativeDirection directionOf(const Vec3d& body) {
  return {radToDeg(std::atan2(body.y, body.x)), radToDeg(std::atan2(-body.z, std::hypot(body.x, body.y)))};
}

}  // namespace

dis::BodyAxes axesAt(const RecordedObject& object, double t_s) {
  const PoseSample pose = poseAt(object, t_s);
  const bool is_told = !std::isnan(pose.heading_deg);
  const dis::LocalAttitude attitude{is_told ? pose.heading_deg : courseAt_deg(object, t_s),
                                    is_told ? pose.pitch_deg : 0, is_told ? pose.roll_deg : 0};
  return dis::axesOf(attitude, pose.latitude_deg, pose.longitude_deg);
}

RelativeDirection directionAt(const RecordedObject& from, const RecordedObject& to, double t_s) {
  return directionOf(axesAt(from, t_s).toBody(spotOf(poseAt(to, t_s)) - spotOf(poseAt(from, t_s))));
}

RelativeDirection turned(const RelativeDirection& direction, const dis::BodyAxes& from,
                         const dis::BodyAxes& to) {
  const double azimuth_rad = degToRad(direction.azimuth_deg),
               elevation_rad = degToRad(direction.elevation_deg);
  const Vec3d body{std::cos(elevation_rad) * std::cos(azimuth_rad),
                   std::cos(elevation_rad) * std::sin(azimuth_rad), -std::sin(elevation_rad)};
  return directionOf(to.toBody(from.toWorld(body)));
}

dis::BodyAxes northAt(const PoseSample& pose) {
  return dis::axesOf(dis::LocalAttitude{}, pose.latitude_deg, pose.longitude_deg);
}

std::vector<BeamState> inAxesOf(const RecordedObject& carrier, const std::vector<BeamState>& states) {
  std::set<double> times;
  for (const BeamState& state : states) times.insert(state.t_s);
  if (!states.empty() && !carrier.poses.empty()) {
    for (const PoseSample& pose : carrier.poses) {
      if (pose.t_s > states.front().t_s) times.insert(pose.t_s);
    }
  }
  std::vector<BeamState> turned_states;
  std::size_t next = 0;
  for (const double t_s : times) {
    while (next < states.size() && states[next].t_s <= t_s) ++next;
    BeamState state = states[next - 1];
    state.t_s = t_s;
    if (!std::isnan(state.azimuth_deg) && !carrier.poses.empty()) {
      const RelativeDirection told{state.azimuth_deg,
                                   std::isnan(state.elevation_deg) ? 0 : state.elevation_deg};
      const RelativeDirection own = turned(told, northAt(poseAt(carrier, t_s)), axesAt(carrier, t_s));
      state.azimuth_deg = own.azimuth_deg;
      state.elevation_deg = own.elevation_deg;
    }
    addState(turned_states, state);
  }
  return turned_states;
}

}  // namespace emscape::interop
