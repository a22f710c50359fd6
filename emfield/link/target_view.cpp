#include "emfield/link/target_view.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "emfield/channels/products.h"
#include "emfield/channels/radar_share.h"
#include "emfield/columns/station.h"
#include "emfield/combine/clutter_echo.h"
#include "emfield/radar/receiver.h"
#include "emscape/base/units.h"

namespace emscape::emfield {
namespace {

/// Shortens an interval around t_s to the leg of a track at t_s, before or after the track to the time there.
void clipToLeg(const std::vector<scenario::TrackPoint>& track, double t_s, double& from_s, double& to_s) {
  if (track.size() < 2) return;
  if (t_s < track.front().t_s) {
    to_s = std::min(to_s, track.front().t_s);
  } else if (t_s > track.back().t_s) {
    from_s = std::max(from_s, track.back().t_s);
  } else {
    const std::size_t leg = scenario::legAt(track, t_s);
    from_s = std::max(from_s, track[leg].t_s);
    to_s = std::min(to_s, track[leg + 1].t_s);
  }
}

constexpr double kHalfStep_s = 0.01;

/// Rate (m/s) of the distance between a radar and a platform.
/// @param has_radar_moved  false: the radar stays where it is at the time
double rangeRate_mps(const scenario::Snapshot& snapshot, int radar, int platform,
                     const scenario::Terrain* terrain, bool has_radar_moved) {
  const scenario::Scenario& scenario = *snapshot.scenario;
  const int carrier = scenario.emitters[static_cast<std::size_t>(radar)].platform;
  double from_s = snapshot.time_s - kHalfStep_s, to_s = snapshot.time_s + kHalfStep_s;
  for (const int moving : {carrier, platform})
    clipToLeg(scenario.platforms[static_cast<std::size_t>(moving)].track, snapshot.time_s, from_s, to_s);
  if (!(to_s > from_s)) from_s = to_s - kHalfStep_s;  // one of them stops where the other turns
  const auto range_m = [&](double t_s) {
    const scenario::Snapshot at = scenario::instantAt(snapshot.scenario, terrain, t_s);
    const scenario::Snapshot& of_radar = has_radar_moved ? at : snapshot;
    return length(toEcef(at.platforms[static_cast<std::size_t>(platform)].position) -
                  toEcef(of_radar.emitters[static_cast<std::size_t>(radar)].position));
  };
  return (range_m(to_s) - range_m(from_s)) / (to_s - from_s);
}

}  // namespace

double rcsTowards_m2(const scenario::Snapshot& snapshot, const scenario::Target& target, int radar) {
  const scenario::PlatformState& carrier = snapshot.platforms[static_cast<std::size_t>(target.platform)];
  const Station station = makeStation(carrier.position, carrier.height_msl_m, snapshot.scenario->atmosphere);
  const Vec3d line = toEcef(snapshot.emitters[static_cast<std::size_t>(radar)].position) - station.ecef_m;
  const Vec3d level{dot(line, station.geodesy.east), dot(line, station.geodesy.north),
                    dot(line, station.geodesy.station.up)};
  const scenario::BeamPose axes = scenario::platformAxes(carrier.attitude);
  const Vec3d aspect{dot(level, axes.forward), dot(level, axes.right), dot(level, axes.up)};
  return target.rcsTowards_m2(radToDeg(std::atan2(aspect.y, aspect.x)),
                              radToDeg(std::atan2(aspect.z, std::hypot(aspect.x, aspect.y))));
}

double radialSpeed_mps(const scenario::Snapshot& snapshot, int radar, int platform,
                       const scenario::Terrain* terrain) {
  return rangeRate_mps(snapshot, radar, platform, terrain, true);
}

double speedOverGround_mps(const scenario::Snapshot& snapshot, int radar, int platform,
                           const scenario::Terrain* terrain) {
  return rangeRate_mps(snapshot, radar, platform, terrain, false);
}

double groundSpread_mps(const scenario::Snapshot& snapshot, int radar, int platform,
                        const scenario::Terrain* terrain) {
  const scenario::Emitter& emitter = snapshot.scenario->emitters[static_cast<std::size_t>(radar)];
  const auto carrier = static_cast<std::size_t>(emitter.platform);
  const scenario::PlatformState& from = snapshot.platforms[carrier];
  double from_s = snapshot.time_s - kHalfStep_s, to_s = snapshot.time_s + kHalfStep_s;
  clipToLeg(snapshot.scenario->platforms[carrier].track, snapshot.time_s, from_s, to_s);
  if (!(to_s > from_s)) from_s = to_s - kHalfStep_s;
  const auto positionAt = [&](double t_s) {
    return toEcef(scenario::instantAt(snapshot.scenario, terrain, t_s).platforms[carrier].position);
  };
  const Vec3d velocity_mps = (positionAt(to_s) - positionAt(from_s)) * (1 / (to_s - from_s));
  const Station station = makeStation(from.position, from.height_msl_m, snapshot.scenario->atmosphere);
  const Vec3d ray = toEcef(snapshot.platforms[static_cast<std::size_t>(platform)].position) - station.ecef_m;
  const Vec3d &east = station.geodesy.east, &north = station.geodesy.north;
  const double across_mps =
      std::abs(dot(velocity_mps, east) * dot(ray, north) - dot(velocity_mps, north) * dot(ray, east)) /
      length(ray);
  RadarTask task;
  task.look = lookOf(emitter, scenario::RadarAim::target);
  const RadarShare share =
      radarShare(*snapshot.scenario, radar, snapshot.emitters[static_cast<std::size_t>(radar)], task, {});
  const Vec3d line = lineTo(station, snapshot.platforms[static_cast<std::size_t>(platform)].position);
  const auto along = [&line](const Vec3f& axis) {
    return static_cast<float>(dot(line, vecCast<double>(axis)) / length(line));
  };
  const Aim aim = aimAt(share.task.look, {along(share.forward), along(share.right), along(share.up)});
  const double widening = std::sqrt(1 - static_cast<double>(aim.steer_v) * static_cast<double>(aim.steer_v)) /
                          static_cast<double>(cosineOfSteering(aim));
  return across_mps * widening * degToRad(emitter.antenna->beamwidth_az_deg) / (4 * std::sqrt(std::log(2.0)));
}

void aimFilter(const scenario::Snapshot& snapshot, int radar, int platform, const scenario::Terrain* terrain,
               scenario::Clutter& clutter) {
  clutter.target_radial_speed_mps = speedOverGround_mps(snapshot, radar, platform, terrain);
  if (clutter.mti) {
    clutter.mti->surface_spread_mps =
        std::hypot(clutter.mti->surface_spread_mps, groundSpread_mps(snapshot, radar, platform, terrain));
  }
}

long long looksUntil(double first_s, double time_s, double period_s) {
  return static_cast<long long>(std::floor((time_s - first_s) / period_s + 1e-9)) + 1;
}

}  // namespace emscape::emfield
