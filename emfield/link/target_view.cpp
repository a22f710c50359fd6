#include "emfield/link/target_view.h"

#include <cmath>

#include "emfield/station.h"
#include "emscape/base/units.h"

namespace emscape::emfield {

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
  constexpr double kStep_s = 0.1;
  const double step_s = snapshot.time_s + kStep_s > snapshot.scenario->clock.duration_s ? -kStep_s : kStep_s;
  const scenario::Snapshot other = scenario::instantAt(snapshot.scenario, terrain, snapshot.time_s + step_s);
  const auto range_m = [&](const scenario::Snapshot& at) {
    return length(toEcef(at.platforms[static_cast<std::size_t>(platform)].position) -
                  toEcef(at.emitters[static_cast<std::size_t>(radar)].position));
  };
  return (range_m(other) - range_m(snapshot)) / step_s;
}

long long looksUntil(double first_s, double time_s, double period_s) {
  return static_cast<long long>(std::floor((time_s - first_s) / period_s + 1e-9)) + 1;
}

}  // namespace emscape::emfield
