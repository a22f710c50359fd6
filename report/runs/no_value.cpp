#include "report/runs/no_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/geodesy/geo_frame.h"
#include "emscape/scenario/model/quantities.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::report {
namespace {

struct Nearest {
  const scenario::Emitter* emitter = nullptr;
  double distance_m = HUGE_VAL;
};

/// The emitter that comes nearest to a position.
/// @param is_exchanged  with the position's latitude and longitude exchanged
Nearest nearestTo(const FrameOrigin& position, bool is_exchanged, const scenario::Scenario& scenario) {
  Nearest nearest;
  const double latitude_deg = is_exchanged ? position.longitude_deg : position.latitude_deg;
  const double longitude_deg = is_exchanged ? position.latitude_deg : position.longitude_deg;
  if (std::abs(latitude_deg) > 90) return nearest;
  for (const scenario::Emitter& emitter : scenario.emitters) {
    for (const scenario::TrackPoint& point :
         scenario.platforms[static_cast<std::size_t>(emitter.platform)].track) {
      const double distance_m = geodesicInverse(latitude_deg, longitude_deg, point.position.latitude_deg,
                                                point.position.longitude_deg)
                                    .distance_m;
      if (distance_m < nearest.distance_m) nearest = {&emitter, distance_m};
    }
  }
  return nearest;
}

/// @param is_of_jamming  the quantity has no value without jamming
std::string likelyCause(const scenario::Scenario& scenario, const std::vector<double>& times_s,
                        bool is_of_jamming) {
  const auto radiates = [&](const scenario::Emitter& emitter) {
    return emitter.enabled &&
           std::any_of(times_s.begin(), times_s.end(), [&](double t_s) { return isActiveAt(emitter, t_s); });
  };
  if (std::none_of(scenario.emitters.begin(), scenario.emitters.end(), radiates))
    return "no emitter transmits then (active_s, enabled)";
  if (is_of_jamming) {
    const bool has_jammer = std::any_of(
        scenario.emitters.begin(), scenario.emitters.end(), [&](const scenario::Emitter& emitter) {
          return emitter.kind == scenario::EmitterKind::jammer && radiates(emitter);
        });
    if (!has_jammer) return "no jammer transmits then (active_s, enabled)";
    return "no radar is jammed: the jammers are outside their bands, or behind terrain or the horizon";
  }
  const scenario::Region& region = scenario.region;
  const double half_m = std::hypot(region.size_m.x, region.size_m.y) / 2;
  const Nearest nearest = nearestTo(region.origin, false, scenario);
  if (nearest.emitter != nullptr && nearest.distance_m > 2 * half_m) {
    const Nearest exchanged = nearestTo(region.origin, true, scenario);
    return fmt::format("the nearest emitter, '{}', is {:.0f} km from the region's origin{}",
                       nearest.emitter->name, nearest.distance_m / 1000,
                       exchanged.distance_m <= 2 * half_m
                           ? "; with the origin's latitude and longitude exchanged it would be inside"
                           : "");
  }
  return "all voxels are behind terrain, below the horizon or out of reach";
}

}  // namespace

std::string noValueWarning(const std::string& quantity, const scenario::Scenario& scenario,
                           const std::vector<double>& times_s) {
  return fmt::format("{}: no voxel is above the floor at {}: {}", quantity,
                     times_s.size() == 1 ? fmt::format("{:g} s", times_s.front()) : "any of the times",
                     likelyCause(scenario, times_s,
                                 quantity.substr(0, quantity.find(':')) ==
                                     scenario::info(scenario::Quantity::jammer_to_signal_db).name));
}

}  // namespace emscape::report
