/// A radar and a jammer on a line of voxels, and the same two for the closed forms.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "emfield/radar/receiver.h"
#include "emscape/base/units.h"
#include "tests/emfield/test_scenario.h"

namespace emscape::emfield::testing {

constexpr double kFrequency_hz = 3e9;
constexpr double kGain_dbi = 30;
constexpr double kFarthest_m = 40e3;
constexpr double kSpacing_m = 1000;

inline scenario::Emitter radarOf(scenario::AntennaPtr antenna) {
  scenario::Emitter radar = plainEmitter("radar", 0);
  radar.kind = scenario::EmitterKind::radar;
  radar.frequency_hz = kFrequency_hz;
  radar.power_w = 2e4;
  radar.losses_db = 2;
  radar.polarization = propagation::Polarization::horizontal;
  radar.antenna = std::move(antenna);
  radar.receiver.noise_figure_db = 4;
  radar.receiver.losses_db = 1;
  radar.receiver.target_rcs_m2 = 5;
  return radar;
}

inline scenario::Emitter trackingRadar() {
  scenario::Emitter radar = radarOf(scenario::makeGaussian(kGain_dbi, 3, 4, -35));
  radar.scan.kind = scenario::ScanKind::track;
  return radar;
}

/// Noise over 20 MHz from an isotropic antenna.
inline scenario::Emitter jammerOf(double power_w) {
  scenario::Emitter jammer = plainEmitter("jammer", 0);
  jammer.kind = scenario::EmitterKind::jammer;
  jammer.frequency_hz = kFrequency_hz;
  jammer.bandwidth_hz = 20e6;
  jammer.power_w = power_w;
  jammer.losses_db = 0.5;
  jammer.polarization = propagation::Polarization::slant_45;
  return jammer;
}

/// The point this far east and north of the middle voxel, in its plane.
inline GeodeticPosition pointAt(const scenario::Scenario& scenario, double east_m, double north_m) {
  const volume::Grid grid = gridOf(scenario.region);
  const Vec3d middle = grid.center_m(grid.dims.x / 2, grid.dims.y / 2, 0);
  return GeoFrame(grid.frame).toGeodetic(middle + Vec3d{east_m, north_m, 0});
}

/// Moves the first platform northwards, through the region's middle at the time 0.
inline void flyNorth(scenario::Scenario& scenario, double speed_mps, double height_ellipsoid_m) {
  std::vector<scenario::TrackPoint>& track = scenario.platforms[0].track;
  track.clear();
  for (const double t_s : {-10.0, 10.0}) {
    track.push_back(fixedPlatform(pointAt(scenario, 0, speed_mps * t_s)).track[0]);
    track.back().t_s = t_s;
    track.back().position.height_ellipsoid_m = height_ellipsoid_m;
  }
}

/// A radar in the middle of a line of voxels, and a jammer.
inline std::shared_ptr<scenario::Scenario> duel(const scenario::Emitter& radar,
                                                const scenario::Emitter& jammer, double jammer_east_m,
                                                double jammer_north_m) {
  auto scenario = lineOfVoxels(kFarthest_m, kSpacing_m);
  addEmitter(*scenario, middleOf(*scenario), radar);
  addEmitter(*scenario, pointAt(*scenario, jammer_east_m, jammer_north_m), jammer);
  return scenario;
}

inline float east(const std::shared_ptr<scenario::Scenario>& scenario, const char* quantity, double range_m) {
  scenario->output.quantities = {quantity};
  return valueEast(*solve(scenario), range_m);
}

/// The same radar and jammer for the closed forms.
inline RadarLink linkTowardsTarget(const scenario::Emitter& radar) {
  RadarLink link = radarLinkOf(radar);
  link.gain_dbi = radar.antenna->gain_dbi;
  return link;
}

inline JammerLink linkTowardsRadar(const scenario::Emitter& jammer, double radar_gain_dbi) {
  JammerLink link;
  link.eirp_w = jammer.power_w * dbToRatio(jammer.antenna->gain_dbi - jammer.losses_db);
  link.bandwidth_hz = jammer.bandwidth_hz;
  link.radar_gain_dbi = radar_gain_dbi;
  link.polarization_loss_db = 10 * std::log10(2.0);
  link.radar_receive_losses_db = 1;
  return link;
}

}  // namespace emscape::emfield::testing
