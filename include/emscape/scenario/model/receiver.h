/// Receivers: at every voxel, and on platforms for links.
#pragma once

#include <optional>
#include <string>

#include "emscape/scenario/model/emitter.h"

namespace emscape::scenario {

/// A receiver without a platform, which is at every voxel: for received_power_dbm, sinr_db and
/// intercept_margin_db.
struct ReceiverProfile {
  std::string name;
  double gain_dbi = 0;                                    ///< in every direction
  double losses_db = 0;                                   ///< between antenna and receiver
  std::optional<propagation::Polarization> polarization;  ///< none: matched to every emitter
  /// 0: tuned to every emitter; for links and sinr_db, to the wanted emitter.
  double center_frequency_hz = 0;
  double bandwidth_hz = 0;  ///< 0: that of the emitter's signal. Noise requires > 0
  double cross_polar_isolation_db = kCrossPolarIsolation_db;
  std::optional<double> noise_figure_db;  ///< referred to 290 K
  double antenna_temperature_k = 290;     ///< noise from sky and ground
  /// Thresholds of reception: a signal is received if it meets all given ones. None: not evaluated.
  std::optional<double> sensitivity_dbm;   ///< minimum power after the losses
  std::optional<double> required_sinr_db;  ///< minimum signal over noise and interference

  bool hasNoise() const { return noise_figure_db && bandwidth_hz > 0; }
  bool hasThreshold() const { return sensitivity_dbm || required_sinr_db; }
};

/// A receiver on a platform, with its own antenna, whose gain replaces `gain_dbi`.
struct PlacedReceiver : ReceiverProfile {
  int platform = -1;   ///< index into Scenario::platforms
  AntennaPtr antenna;  ///< not null
  ScanSpec scan;
};

}  // namespace emscape::scenario
