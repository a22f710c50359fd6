#include "emfield/link/jammers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "emfield/columns/station.h"
#include "emfield/columns/two_rays.h"
#include "emfield/combine/combine.h"
#include "emscape/base/error.h"
#include "emscape/base/units.h"
#include "emscape/emfield/link/path_budget.h"
#include "scenario/scan/scan_sweep.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;
using scenario::EmitterState;

/// Ground distance (m) between two stations below which no path is computed, because there is no obstacle.
constexpr double kNoPath_m = 2;

double freeSpaceDensity_wm2(const Emitter& emitter, const scenario::BeamPose& beam, const Vec3d& line) {
  const double distance_m = std::max(length(line), static_cast<double>(kMinDistance_m));
  const Vec3d unit = length(line) > 0 ? line / length(line) : beam.forward;
  const double amplitude = emitter.antenna->amplitudeTowards(
      {dot(unit, beam.forward), dot(unit, beam.right), dot(unit, beam.up)}, beam.steer_u, beam.steer_v);
  return emitter.power_w * dbToRatio(emitter.antenna->gain_dbi - emitter.losses_db) * amplitude * amplitude /
         (4 * kPi * distance_m * distance_m);
}

/// Whether an emitter radiates at some time of a duration.
bool radiates(const scenario::Snapshot& snapshot, const Emitter& emitter, double duration_s) {
  return duration_s > 0 && !scenario::activeTimes(snapshot, emitter, duration_s).empty();
}

}  // namespace

std::vector<JammerPath> jammerPaths(const scenario::Snapshot& snapshot, int radar,
                                    const std::vector<int>& jammers, const scenario::Terrain* terrain,
                                    std::string* warning, double duration_s) {
  const scenario::Scenario& scenario = *snapshot.scenario;
  const EmitterState& at = snapshot.emitters[radar];
  const Station station = makeStation(at.position, at.height_msl_m, scenario.atmosphere);
  std::vector<JammerPath> all;
  for (int j : jammers) {
    const EmitterState& from = snapshot.emitters[j];
    if (scenario.emitters[j].platform == scenario.emitters[radar].platform) continue;
    if (!from.active && !radiates(snapshot, scenario.emitters[j], duration_s)) continue;
    const Station jammer_station = makeStation(from.position, from.height_msl_m, scenario.atmosphere);
    Vec3d ray = lineTo(station, from.position);
    const double level_m = std::hypot(ray.x, ray.y);
    JammerPath jammer;
    jammer.jammer = j;
    const auto alone = [&] {
      return freeSpaceDensity_wm2(scenario.emitters[j], from.beam, lineTo(jammer_station, at.position));
    };
    if (level_m < kNoPath_m) {
      jammer.power_density_wm2 = alone();
    } else {
      try {
        scenario::Snapshot there;  // of a platform that comes in the course of the duration
        const auto platform = static_cast<std::size_t>(scenario.emitters[j].platform);
        const bool is_absent = !snapshot.platforms[platform].present;
        if (is_absent) {
          there = snapshot;
          there.platforms[platform].present = true;
        }
        const PathBudget budget = pathBudget(is_absent ? there : snapshot, j, {at.position, at.height_msl_m},
                                             scenario.emitters[j].propagation.model, terrain);
        jammer.power_density_wm2 = dbToRatio(budget.find("power_density_dbwm2")->value);
        ray.z += refractionLift_m(station, budget.profile.range_m, level_m, from.height_msl_m);
        if (const auto& reflection = budget.excess.reflection) {
          jammer.power_density_wm2 = dbToRatio(budget.boresight_dbwm2);
          jammer.reflected = {
              *reflection, vecCast<double>(reflectedDirection(vecCast<float>(ray), reflection->arrival_sine)),
              budget.pointing.amplitude, budget.pointing.reflected->amplitude};
        }
      } catch (const Error& error) {
        const std::string message = fmt::format("jammer '{}' to radar '{}': {}", scenario.emitters[j].name,
                                                scenario.emitters[radar].name, error.message());
        if (warning == nullptr) {
          throw Error(ErrorCode::bad_input, {scenario.file}, message, Hint::allow_missing_terrain);
        }
        *warning = message + "; counted as a free path";
        jammer.power_density_wm2 = alone();
      }
    }
    jammer.direction = length(ray) > 0 ? ray / length(ray) : at.beam.forward;
    all.push_back(jammer);
  }
  return all;
}

}  // namespace emscape::emfield
