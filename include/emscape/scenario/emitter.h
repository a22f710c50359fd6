/// What radiates, and how a receiver is described.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/propagation/settings.h"
#include "emscape/scenario/antenna.h"
#include "emscape/scenario/scan.h"

namespace emscape::scenario {

enum class EmitterKind { radar, transmitter, jammer };

const char* toString(EmitterKind kind);

/// How far (dB) an antenna keeps the orthogonal polarisation down unless a receiver says otherwise: what
/// antennas of one nominal polarisation reach off their axis.
/// @see D. L. Adamy, EW 101, 2001, chapter 3: about 25 dB between orthogonal linear, and between circular
/// senses
constexpr double kCrossPolarIsolation_db = 25;

/// Part of the power (0..1) that passes between two polarisations: |<e_t, e_r>|^2, at least what a real
/// antenna lets through of the orthogonal one.
/// @param isolation_db  >= 0; infinity: ideal antennas
double polarizationFactor(propagation::Polarization transmit, propagation::Polarization receive,
                          double isolation_db = kCrossPolarIsolation_db);

/// How the probability of detection is found from the signal-to-noise ratio.
enum class DetectionMethod {
  exact,       ///< Marcum's and Swerling's statistics
  albersheim,  ///< Albersheim's formula: steady targets alone
  shnidman     ///< Shnidman's formula
};
const char* toString(DetectionMethod method);

/// A radar's own receiver: what turns power density into signal-to-noise and into detections.
struct RadarReceiver {
  double noise_figure_db = 0;
  double antenna_temperature_k = 290;  ///< what the antenna sees of sky and ground
  double bandwidth_hz = 1e6;
  double losses_db = 0;           ///< between antenna and receiver, one way: echo and jamming alike
  double processing_gain_db = 0;  ///< of echoes over noise and jamming, less the losses of processing
  std::optional<propagation::Polarization> polarization;  ///< none: that of the transmitted wave
  double cross_polar_isolation_db = kCrossPolarIsolation_db;
  int pulses = 1;
  double pfa = 1e-6;
  int swerling = 1;  ///< 0..4
  DetectionMethod detection = DetectionMethod::exact;
  /// For burn-through; none: what a probability of detection of 1/2 takes against noise.
  std::optional<double> required_signal_to_jammer_db;
  double target_rcs_m2 = 1;
};

/// A receiver placed at every voxel, for received_power_dbm.
struct ReceiverProfile {
  std::string name;
  double gain_dbi = 0;
  double losses_db = 0;
  std::optional<propagation::Polarization> polarization;  ///< none: matched to every emitter
  double center_frequency_hz = 0;                         ///< 0: tuned to every emitter
  double bandwidth_hz = 0;                                ///< 0: as wide as the emitter's signal
  double cross_polar_isolation_db = kCrossPolarIsolation_db;
};

/// [begin, end) in seconds since the epoch.
struct TimeInterval {
  double begin_s = 0;
  double end_s = 0;
};

struct Emitter {
  std::string name;
  int platform = -1;  ///< index into Scenario::platforms
  EmitterKind kind = EmitterKind::transmitter;
  double frequency_hz = 0;
  double bandwidth_hz = 0;  ///< of the signal; 0: narrower than any receiver
  double power_w = 0;       ///< peak, at the transmitter's output
  double losses_db = 0;     ///< transmit path, one way, >= 0
  propagation::Polarization polarization = propagation::Polarization::vertical;
  AntennaPtr antenna;
  ScanSpec scan;
  propagation::ModelSettings propagation;
  RadarReceiver receiver;              ///< radars only
  std::vector<TimeInterval> active_s;  ///< empty: always
  SourceLocation place;                ///< where the scenario describes it
  SourceLocation frequency_place;      ///< and its frequency
};

}  // namespace emscape::scenario
