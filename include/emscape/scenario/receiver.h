/// Receivers on platforms, for links.
#pragma once

#include <optional>
#include <string>

#include "emscape/scenario/emitter.h"

namespace emscape::scenario {

/// A receiver on a platform, with its own antenna.
struct PlacedReceiver {
  std::string name;
  int platform = -1;   ///< index into Scenario::platforms
  AntennaPtr antenna;  ///< not null
  ScanSpec scan;
  double losses_db = 0;  ///< between antenna and receiver
  double noise_figure_db = 0;
  double antenna_temperature_k = 290;                     ///< noise from sky and ground
  std::optional<propagation::Polarization> polarization;  ///< none: matched to every emitter
  double cross_polar_isolation_db = kCrossPolarIsolation_db;
  double center_frequency_hz = 0;  ///< 0: tuned to the emitter that is listened to
  double bandwidth_hz = 0;         ///< > 0
  /// Thresholds of reception; a signal is received where it meets those that are given. None: not judged.
  std::optional<double> sensitivity_dbm;   ///< smallest power after the losses
  std::optional<double> required_sinr_db;  ///< smallest signal over noise and interference

  bool hasThreshold() const { return sensitivity_dbm || required_sinr_db; }
};

}  // namespace emscape::scenario
