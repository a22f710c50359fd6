#include "emscape/scenario/model/snapshot.h"

#include <fmt/format.h>

#include <cmath>

#include "emscape/base/geodesy/geoid.h"
#include "emscape/base/units.h"
#include "scenario/model/ground_tolerance.h"
#include "scenario/model/posed_platform.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::scenario {

namespace {

std::string whereAndWhen(const Platform& platform, const SitePosition& at, double t_s) {
  return fmt::format("platform '{}' at t = {} s ({:.6f}, {:.6f} deg)", platform.name, t_s, at.latitude_deg,
                     at.longitude_deg);
}

/// Ground (m above mean sea level) below a platform: 0 without terrain, NaN where the terrain is missing.
double groundHeight_m(const Scenario& scenario, const Terrain* terrain, const SitePosition& at) {
  if (!scenario.terrain) return 0;
  return terrain == nullptr ? std::nan("") : terrain->heightMsl_m(at.latitude_deg, at.longitude_deg);
}

/// Why there is no ground at a point.
std::string missingGroundText(const Terrain& terrain, const SitePosition& at) {
  const GeoBox box = terrain.coverage();
  const bool is_covered = at.latitude_deg >= box.south_deg && at.latitude_deg <= box.north_deg &&
                          at.longitude_deg >= box.west_deg && at.longitude_deg <= box.east_deg;
  return (is_covered ? "the terrain is missing there: void posts, or a gap between the files; "
                     : "the terrain is missing there; ") +
         terrain.placeText();
}

PlatformState stateAt(const Scenario& scenario, const Terrain* terrain, const Platform& platform,
                      double t_s) {
  const TrackPoint point = pointAt(platform, t_s);
  const SitePosition& at = point.position;
  const double undulation_m = geoidUndulation_m(at.latitude_deg, at.longitude_deg);
  const double ground_m = groundHeight_m(scenario, terrain, at);
  PlatformState state;
  state.present = platform.isPresentAt(t_s);
  if (at.height_agl_m) {
    if (std::isnan(ground_m)) {
      throw Error(
          ErrorCode::bad_input, platform.location,
          fmt::format("{}: its height is given above ground, but {}", whereAndWhen(platform, at, t_s),
                      terrain == nullptr ? "the terrain was not loaded" : missingGroundText(*terrain, at)));
    }
    state.height_msl_m = ground_m + *at.height_agl_m;
  } else {
    state.height_msl_m = at.height_msl_m ? *at.height_msl_m : *at.height_ellipsoid_m - undulation_m;
  }
  if (ground_m - state.height_msl_m > kGroundTolerance_m) {
    throw Error(
        ErrorCode::bad_input, platform.location,
        fmt::format("{} is {:.1f} m below {}: it is at {:.1f} m, the ground at {:.1f} m above mean sea level",
                    whereAndWhen(platform, at, t_s), ground_m - state.height_msl_m,
                    scenario.terrain ? "ground" : "the smooth earth in place of the missing terrain",
                    state.height_msl_m, ground_m));
  }
  state.position = {at.latitude_deg, wrapLongitude_deg(at.longitude_deg), state.height_msl_m + undulation_m};
  state.attitude = {point.heading_deg.value_or(0), point.pitch_deg.value_or(0), point.roll_deg.value_or(0)};
  return state;
}

/// Rotates an orthonormal pair of vectors in their plane: a towards b.
void turn(Vec3d& a, Vec3d& b, double angle_deg) {
  const double c = std::cos(degToRad(angle_deg)), s = std::sin(degToRad(angle_deg));
  const Vec3d turned_a = a * c + b * s;
  b = b * c - a * s;
  a = turned_a;
}

void aim(BeamPose& pose, double azimuth_deg, double elevation_deg) {
  turn(pose.forward, pose.right, azimuth_deg);
  turn(pose.forward, pose.up, elevation_deg);
}

bool isArray(const AntennaPtr& antenna) {
  return antenna && antenna->is_array;
}

BeamPose beamPose(BeamPose pose, const AntennaPtr& antenna, const ScanSpec& scan, double t_s) {
  const BeamDirection beam = beamAt(scan, t_s);
  if (!beam.electronic) {
    aim(pose, beam.azimuth_deg, beam.elevation_deg);
    return pose;
  }
  aim(pose, scan.azimuth_deg, scan.elevation_deg);
  if (isArray(antenna)) {
    const double azimuth_rad = degToRad(beam.azimuth_deg), elevation_rad = degToRad(beam.elevation_deg);
    pose.steer_u = std::sin(azimuth_rad) * std::cos(elevation_rad);
    pose.steer_v = std::sin(elevation_rad);
  } else {
    aim(pose, beam.azimuth_deg, beam.elevation_deg);
  }
  return pose;
}

/// The beam along the straight line to another position; level across it.
BeamPose poseTowards(const GeodeticPosition& from, const GeodeticPosition& to, const BeamPose& otherwise) {
  constexpr double kLeast_m = 0.1;
  const Vec3d ecef = toEcef(to) - toEcef(from);
  const double latitude_rad = degToRad(from.latitude_deg), longitude_rad = degToRad(from.longitude_deg);
  const double north_to_axis = std::sin(latitude_rad), up_to_axis = std::cos(latitude_rad);
  const double outward = ecef.x * std::cos(longitude_rad) + ecef.y * std::sin(longitude_rad);
  const Vec3d ray{ecef.y * std::cos(longitude_rad) - ecef.x * std::sin(longitude_rad),
                  ecef.z * up_to_axis - outward * north_to_axis,
                  ecef.z * north_to_axis + outward * up_to_axis};  // east, north, up
  if (!(length(ray) > kLeast_m)) return otherwise;
  BeamPose pose = platformAxes({0, 0, 0});
  aim(pose, radToDeg(std::atan2(ray.x, ray.y)), radToDeg(std::atan2(ray.z, std::hypot(ray.x, ray.y))));
  return pose;
}

BeamPose mountPose(BeamPose pose, const Emitter& emitter) {
  const ScanSpec& scan = emitter.scan;
  if (isSteered(emitter)) {
    aim(pose, scan.azimuth_deg, scan.elevation_deg);
  } else if (scan.kind == ScanKind::sector || scan.kind == ScanKind::raster) {
    aim(pose, scan.azimuth_deg, 0);
  }
  return pose;
}

}  // namespace

std::vector<TimeInterval> activeTimes(const Snapshot& at, const Emitter& emitter, double duration_s) {
  const PlatformState& carrier = at.platforms[static_cast<std::size_t>(emitter.platform)];
  if (!carrier.is_posed) return activeTimes(*at.scenario, emitter, at.time_s, duration_s);
  return carrier.present ? activeTimes(emitter, at.time_s, duration_s) : std::vector<TimeInterval>();
}

BeamPose aimed(BeamPose pose, double azimuth_deg, double elevation_deg) {
  aim(pose, azimuth_deg, elevation_deg);
  return pose;
}

BeamPose platformAxes(const Attitude& attitude) {
  // North, east, up, turned by yaw, then pitch, then roll.
  BeamPose pose;
  pose.forward = {0, 1, 0};
  pose.right = {1, 0, 0};
  pose.up = {0, 0, 1};
  aim(pose, attitude.heading_deg, attitude.pitch_deg);
  turn(pose.up, pose.right, attitude.roll_deg);
  return pose;
}

bool isSteered(const Emitter& emitter) {
  return isArray(emitter.antenna) &&
         (emitter.scan.kind == ScanKind::dwell_list || emitter.scan.kind == ScanKind::fixed);
}

namespace {

/// @param interval  in which emitters are active
Snapshot snapshotOf(const std::shared_ptr<const Scenario>& scenario, const IntervalSpec& interval,
                    const Terrain* terrain, double t_s, const std::vector<PlatformPose>& poses = {}) {
  requireTime(scenario->clock, t_s);
  Snapshot snapshot;
  snapshot.time_s = t_s;
  snapshot.time_utc = utcAt(scenario->clock, t_s);
  snapshot.scenario = scenario;
  const std::vector<const PlatformPose*> pose_of = posesByPlatform(*scenario, poses);
  for (std::size_t p = 0; p < scenario->platforms.size(); ++p) {
    const Platform& platform = scenario->platforms[p];
    snapshot.platforms.push_back(
        stateAt(*scenario, terrain, pose_of[p] == nullptr ? platform : posed(platform, *pose_of[p]), t_s));
    snapshot.platforms.back().is_posed = pose_of[p] != nullptr;
  }
  for (const Emitter& emitter : scenario->emitters) {
    const PlatformState& carrier = snapshot.platforms[static_cast<std::size_t>(emitter.platform)];
    EmitterState state;
    const double duration_s = intervalDuration_s(interval, emitter.scan, scenario->clock);
    state.active = duration_s > 0 ? !activeTimes(snapshot, emitter, duration_s).empty()
                                  : carrier.present && isActiveAt(emitter, t_s);
    state.position = carrier.position;
    state.height_msl_m = carrier.height_msl_m;
    const BeamPose axes = platformAxes(carrier.attitude);
    state.beam = beamPose(axes, emitter.antenna, emitter.scan, t_s);
    if (emitter.scan.kind == ScanKind::victim) {
      const PlatformState& victim = snapshot.platforms[static_cast<std::size_t>(emitter.scan.victim)];
      state.beam = poseTowards(carrier.position, victim.position, state.beam);
    }
    state.mount = mountPose(axes, emitter);
    snapshot.emitters.push_back(state);
  }
  for (const PlacedReceiver& receiver : scenario->placed_receivers) {
    const PlatformState& carrier = snapshot.platforms[static_cast<std::size_t>(receiver.platform)];
    snapshot.receivers.push_back(
        {carrier.position, carrier.height_msl_m,
         beamPose(platformAxes(carrier.attitude), receiver.antenna, receiver.scan, t_s)});
  }
  return snapshot;
}

}  // namespace

Snapshot snapshotAt(const std::shared_ptr<const Scenario>& scenario, const Terrain* terrain, double t_s) {
  return snapshotOf(scenario, scenario->output.interval, terrain, t_s);
}

Snapshot snapshotAt(const std::shared_ptr<const Scenario>& scenario, const Terrain* terrain, double t_s,
                    const std::vector<PlatformPose>& poses) {
  return snapshotOf(scenario, scenario->output.interval, terrain, t_s, poses);
}

Snapshot instantAt(const std::shared_ptr<const Scenario>& scenario, const Terrain* terrain, double t_s) {
  return snapshotOf(scenario, {}, terrain, t_s);
}

}  // namespace emscape::scenario
