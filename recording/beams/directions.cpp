#include "recording/beams/directions.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "recording/common/samples.h"

namespace emscape::interop {
namespace {

/// The heading of an object that tells none is along its track.
double courseAt_deg(const RecordedObject& object, double t_s) {
  const PoseSample a = poseAt(object, t_s - 0.5), b = poseAt(object, t_s + 0.5);
  return radToDeg(
      geodesicInverse(a.latitude_deg, a.longitude_deg, b.latitude_deg, b.longitude_deg).azimuth_rad);
}

constexpr std::size_t kMaxTurns = 5000;
constexpr double kTurn_deg = 0.02;  ///< a smaller one of the carrier is none

/// The times after `begin_s` at which an object has turned.
std::vector<double> timesOfTurns(const RecordedObject& object, double begin_s) {
  std::vector<double> times;
  const PoseSample* last = nullptr;
  const auto differs = [](double a, double b) { return !(std::abs(std::remainder(a - b, 360)) < kTurn_deg); };
  for (const PoseSample& pose : object.poses) {
    const bool has_turned = last == nullptr || differs(pose.heading_deg, last->heading_deg) ||
                            differs(pose.pitch_deg, last->pitch_deg) ||
                            differs(pose.roll_deg, last->roll_deg);
    if (!has_turned) continue;
    last = &pose;
    if (pose.t_s > begin_s) times.push_back(pose.t_s);
  }
  const std::size_t stride = times.size() / kMaxTurns + 1;
  std::vector<double> some;
  for (std::size_t i = 0; i < times.size(); i += stride) some.push_back(times[i]);
  return some;
}

RelativeDirection directionOf(const Vec3d& body) {
  return {radToDeg(std::atan2(body.y, body.x)), radToDeg(std::atan2(-body.z, std::hypot(body.x, body.y)))};
}

/// The states of a beam in the axes of its carrier.
std::vector<BeamState> inAxesOf(const RecordedObject& carrier, const std::vector<BeamState>& states) {
  if (states.empty() || carrier.poses.empty()) return states;
  std::set<double> times;
  for (const BeamState& state : states) times.insert(state.t_s);
  for (const double t_s : timesOfTurns(carrier, states.front().t_s)) times.insert(t_s);
  std::vector<BeamState> turned_states;
  std::size_t next = 0;
  for (const double t_s : times) {
    while (next < states.size() && states[next].t_s <= t_s) ++next;
    BeamState state = states[next - 1];
    state.t_s = t_s;
    if (!std::isnan(state.azimuth_deg)) {
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

}  // namespace

Vec3d spotOf(const PoseSample& pose) {
  return toEcef({pose.latitude_deg, pose.longitude_deg, pose.height_msl_m});
}

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

void turnIntoCarriers(Recording& recording, const std::vector<bool>& is_from_north) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < recording.beams.size(); ++i) {
    RecordedBeam& beam = recording.beams[i];
    if (is_from_north[i]) beam.states = inAxesOf(recording.objects[beam.object], beam.states);
    count += beam.states.size();
    if (count > RecordingLimits::kSamples) {
      throw Error(ErrorCode::bad_input,
                  fmt::format("more than {} states of beams on carriers that turn; cut the "
                              "recording into parts",
                              RecordingLimits::kSamples));
    }
  }
}

}  // namespace emscape::interop
