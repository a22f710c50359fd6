#include "emfield/channels/radar_clutter.h"

#include <cmath>

#include "emfield/radar/receiver.h"
#include "emscape/base/units.h"
#include "propagation/air/air_loss.h"

namespace emscape::emfield {
namespace {

using scenario::Emitter;

/// Signal-to-noise of an echo of 1 m2 at 1 m on boresight.
double echoOfUnit(const Emitter& radar) {
  RadarLink link = radarLinkOf(radar);
  link.gain_dbi = radar.antenna->gain_dbi;
  return dbToRatio(radarSnrDb(link, 1, 1));
}

double improvement(const Emitter& radar, double scenario::Mti::*spread_mps) {
  const std::optional<MtiFilter> filter = mtiFilterOf(radar);
  return filter ? filter->improvement(filter->mti.*spread_mps, radar.clutter->target_radial_speed_mps) : 1;
}

}  // namespace

std::optional<MtiFilter> mtiFilterOf(const Emitter& radar) {
  if (!radar.clutter || !radar.clutter->mti || !radar.waveform) return std::nullopt;
  return MtiFilter{*radar.clutter->mti, radar.waveform->prf_hz, radar.frequency_hz};
}

double filterResponse(const Emitter& radar) {
  const std::optional<MtiFilter> filter = mtiFilterOf(radar);
  return filter ? filter->response(radar.clutter->target_radial_speed_mps) : 1;
}

double surfaceImprovement(const Emitter& radar) {
  return improvement(radar, &scenario::Mti::surface_spread_mps);
}

double rainImprovement(const Emitter& radar) {
  return improvement(radar, &scenario::Mti::rain_spread_mps);
}

ClutterTask clutterTask(const scenario::Scenario& scenario, const Emitter& radar) {
  const std::shared_ptr<const ClutterBeam> held = clutterBeamOf(radar.antenna);
  const ClutterBeam& beam = *held;
  const double unit = echoOfUnit(radar);
  ClutterTask task;
  if (radar.clutter->hasSurface()) {
    task.surface = static_cast<float>(unit * beam.azimuth_rad / surfaceImprovement(radar));
  }
  if (radar.clutter->rain) {
    const double reflectivity = rainReflectivity_m2_m3(scenario.atmosphere.rain_mm_h, radar.frequency_hz);
    task.rain = static_cast<float>(unit * reflectivity * beam.azimuth_rad * beam.elevation_rad *
                                   radar.clutter->range_cell_m / rainImprovement(radar));
    task.rain_octaves_per_m =
        static_cast<float>(0.2 * airLossAtSea_db_per_m(scenario, radar) * std::log2(10.0));
    task.below = beam.below;
  }
  return task;
}

ClutterTask placedAt(const scenario::EmitterState& state, const scenario::Scenario& scenario,
                     ClutterTask task) {
  if (task.rain == 0) return task;
  const propagation::Atmosphere& air = scenario.atmosphere;
  const Station station = makeStation(state.position, state.height_msl_m, air);
  const double top_msl_m = air.rain_height_m.value_or(propagation::rainHeight_m(state.position.latitude_deg));
  task.rain_top_m = static_cast<float>(top_msl_m - state.height_msl_m);
  task.sea_level_m = static_cast<float>(-state.height_msl_m);
  task.curvature_per_m = static_cast<float>(0.5 / station.effective_earth_radius_m);
  return task;
}

}  // namespace emscape::emfield
