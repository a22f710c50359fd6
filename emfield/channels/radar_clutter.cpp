#include "emfield/channels/radar_clutter.h"

#include <algorithm>
#include <cmath>
#include <vector>

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

/// @param sums       of a cut's two-way power from -90 degrees on, up to evenly spaced elevations
/// @param width_rad  of the beam
PowerBelow powerBelow(const std::vector<double>& sums, double width_rad) {
  constexpr double kReach = 4, kLeast = 1e-9;  // widths; part
  const double intervals = static_cast<double>(sums.size() - 1);
  PowerBelow below;
  below.reach_rad = static_cast<float>(std::min(kReach * width_rad, kPi / 2));
  for (int n = 0; n < PowerBelow::kNodes; ++n) {
    const double angle_rad = static_cast<double>(below.reach_rad) * (2.0 * n / (PowerBelow::kNodes - 1) - 1);
    const double at = std::clamp((angle_rad / kPi + 0.5) * intervals, 0.0, intervals - 1e-6);
    const auto edge = static_cast<std::size_t>(at);
    const double sum = sums[edge] + (at - static_cast<double>(edge)) * (sums[edge + 1] - sums[edge]);
    const double part = std::clamp(sum / sums.back(), kLeast, 1 - kLeast);
    below.log2_odds[n] = static_cast<float>(std::log2(part / (1 - part)));
  }
  return below;
}

}  // namespace

ClutterBeam clutterBeam(const scenario::Antenna& antenna) {
  constexpr double kPerBeamwidth = 64, kLeastSamples = 3600, kMostSamples = 36000;
  const double beamwidth_deg = std::min(antenna.beamwidth_az_deg, antenna.beamwidth_el_deg);
  const int samples =
      static_cast<int>(std::clamp(180 * kPerBeamwidth / beamwidth_deg, kLeastSamples, kMostSamples));
  const auto power = [&](double azimuth_rad, double elevation_rad) {
    const double level = std::cos(elevation_rad);
    const double amplitude = antenna.amplitudeTowards(
        {level * std::cos(azimuth_rad), level * std::sin(azimuth_rad), std::sin(elevation_rad)}, 0, 0);
    return std::pow(amplitude, 4);
  };
  ClutterBeam beam;
  double highest = 0, highest_rad = 0;
  std::vector<double> sums{0};  // up to the upper edge of each sample
  for (int n = 0; n < samples; ++n) {
    const double elevation_rad = kPi * ((n + 0.5) / samples - 0.5), here = power(0, elevation_rad);
    sums.push_back(sums.back() + here * std::cos(elevation_rad) * kPi / samples);
    if (here > highest) {
      highest = here;
      highest_rad = elevation_rad;
    }
  }
  beam.elevation_rad = sums.back();
  double highest_of_azimuth = highest;
  for (int n = 0; n < samples; ++n) {
    const double here = power(2 * kPi * n / samples, highest_rad);
    beam.azimuth_rad += here * 2 * kPi / samples;
    highest_of_azimuth = std::max(highest_of_azimuth, here);
  }
  if (!(highest > 0)) return {};
  beam.azimuth_rad /= highest_of_azimuth;
  beam.elevation_rad /= highest;
  beam.below = powerBelow(sums, beam.elevation_rad);
  return beam;
}

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
  const ClutterBeam beam = clutterBeam(*radar.antenna);
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
