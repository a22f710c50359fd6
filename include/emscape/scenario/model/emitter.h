/// Emitters.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "emscape/base/enum_names.h"
#include "emscape/base/error.h"
#include "emscape/propagation/settings.h"
#include "emscape/scenario/antenna/antenna.h"
#include "emscape/scenario/model/clutter.h"
#include "emscape/scenario/model/waveform.h"
#include "emscape/scenario/scan/scan.h"

namespace emscape::scenario {

using emscape::toString;

enum class EmitterKind { radar, transmitter, jammer };
constexpr auto namesOf(EmitterKind) {
  return std::array{"radar", "transmitter", "jammer"};
}

/// Default cross-polarisation isolation (dB) of antennas: a typical value off the axis.
/// @see D. L. Adamy, EW 101, 2001, chapter 3: about 25 dB between orthogonal linear, and between circular
/// senses
constexpr double kCrossPolarIsolation_db = 25;

/// Polarisation match (0..1, in power): |<e_t, e_r>|^2, but not below the limit of the isolation.
/// @param isolation_db  >= 0; infinity: ideal antennas
double polarizationFactor(propagation::Polarization transmit, propagation::Polarization receive,
                          double isolation_db = kCrossPolarIsolation_db);

/// Method that computes the probability of detection from the signal-to-noise ratio.
enum class DetectionMethod {
  exact,       ///< Marcum's and Swerling's statistics
  albersheim,  ///< Albersheim's formula: steady targets only
  shnidman     ///< Shnidman's formula
};
constexpr auto namesOf(DetectionMethod) {
  return std::array{"exact", "albersheim", "shnidman"};
}

/// Method for the beam-shape loss of a scanning antenna: pulses received off the beam's peak.
enum class BeamShapeLoss { none, blake, barton };
constexpr auto namesOf(BeamShapeLoss) {
  return std::array{"none", "blake", "barton"};
}

/// Side-lobe blanking: the receiver is shut for pulses that are stronger, by a threshold, in an auxiliary
/// channel with an omnidirectional antenna than in the radar's own.
/// @see L. Maisel, Performance of sidelobe blanking systems, IEEE Trans. AES-4 (1968), p. 174
struct SideLobeBlanking {
  double auxiliary_gain_dbi = 0;  ///< of the auxiliary antenna, in every direction
  double threshold_db = 0;        ///< auxiliary over main power from which a pulse is blanked
};

/// A radar's own receiver, for signal-to-noise ratio and detection.
struct RadarReceiver {
  double noise_figure_db = 0;
  double antenna_temperature_k = 290;  ///< noise from sky and ground
  double bandwidth_hz = 1e6;
  double losses_db = 0;           ///< between antenna and receiver, one way; for echo and jamming
  double processing_gain_db = 0;  ///< of echoes over noise and jamming, net of processing losses
  std::optional<propagation::Polarization> polarization;  ///< none: that of the transmitted wave
  double cross_polar_isolation_db = kCrossPolarIsolation_db;
  int pulses = 1;  ///< integrated on a target; by default from the waveform and the scan
  double pfa = 1e-6;
  int swerling = 1;  ///< 0..4
  DetectionMethod detection = DetectionMethod::exact;
  BeamShapeLoss beam_shape_loss = BeamShapeLoss::none;
  int cfar_cells = 0;        ///< reference cells of a cell-averaging CFAR; 0: known noise level
  int binary_threshold = 0;  ///< M of M-of-N integration, N = pulses; 0: the pulses are summed
  /// For burn-through; none: the ratio that gives a probability of detection of 1/2 in noise.
  std::optional<double> required_signal_to_jammer_db;
  std::optional<SideLobeBlanking> side_lobe_blanking;
  double target_rcs_m2 = 1;
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
  std::optional<Waveform> waveform;    ///< of radars and jammers; none: power_w is also the mean power
  std::optional<Clutter> clutter;      ///< radars with a waveform only; none: only noise and jamming
  bool enabled = true;                 ///< false: it never transmits, whatever active_s is
  std::vector<TimeInterval> active_s;  ///< empty: always
  SourceLocation location;             ///< in the scenario
  SourceLocation frequency_location;   ///< of its frequency

  /// Mean over peak power, (0..1].
  double dutyCycle() const { return waveform ? waveform->dutyCycle() : 1; }
  /// True if it transmits at all times.
  bool isAlwaysActive() const { return enabled && active_s.empty(); }
};

}  // namespace emscape::scenario
