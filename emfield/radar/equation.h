/// The radar range equation, jamming and noise: closed forms for one radar, one target and one jammer.
///
/// The excess of a path over free space is one-way (dB) and enters twice for an echo: with the one-way
/// voltage factor F it is -20 log10 F, and an echo has the factor F^4. The same holds for gases and rain.
/// Jamming is one-way.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/base/units.h"

namespace emscape::emfield {

/// A monostatic radar.
struct RadarLink {
  double power_w = 0;       ///< peak, > 0
  double frequency_hz = 0;  ///< > 0
  double gain_dbi = 0;      ///< toward the target
  double losses_db = 0;     ///< transmitter's, receiver's and processing losses together
  double bandwidth_hz = 0;  ///< of the receiver, > 0
  double noise_temperature_k = kReferenceTemperature_K;  ///< of the system, > 0
};

/// A jammer of noise with uniform spectral density in its band.
struct JammerLink {
  double eirp_w = 0;                   ///< toward the radar, > 0
  double frequency_hz = 0;             ///< middle of its band; 0: the radar's
  double bandwidth_hz = 0;             ///< >= 0
  double radar_gain_dbi = 0;           ///< of the radar's antenna toward the jammer
  double polarization_loss_db = 0;     ///< between jammer and radar
  double radar_receive_losses_db = 0;  ///< of the radar's receive path
};

/// Part (0..1) of a signal's power within a receiver's band. The signal has uniform density in its band; a
/// signal of zero width is inside or outside.
EMSCAPE_HD inline double bandOverlap(double signal_hz, double signal_width_hz, double receiver_hz,
                                     double receiver_width_hz) {
  const double begin_hz = std::fmax(receiver_hz - receiver_width_hz / 2, signal_hz - signal_width_hz / 2);
  const double end_hz = std::fmin(receiver_hz + receiver_width_hz / 2, signal_hz + signal_width_hz / 2);
  if (end_hz < begin_hz) return 0;
  return signal_width_hz > 0 ? (end_hz - begin_hz) / signal_width_hz : 1;
}

/// Echo power (W) at the radar's receiver:
///   S = P G^2 lambda^2 sigma / ((4 pi)^3 R^4 L A^2)
/// @param range_m    > 0
/// @param rcs_m2     radar cross-section, >= 0
/// @param excess_db  loss of the path above free space, one way
/// @see Skolnik, Introduction to Radar Systems, 3rd ed., eq. (1.6)
EMSCAPE_HD inline double echoPower_w(const RadarLink& radar, double rcs_m2, double range_m,
                                     double excess_db = 0) {
  const double four_pi = 4 * kPi;
  const double lambda_m = wavelength_m(radar.frequency_hz);
  const double range2_m2 = range_m * range_m;
  return radar.power_w * lambda_m * lambda_m * rcs_m2 /
         (four_pi * four_pi * four_pi * range2_m2 * range2_m2) *
         std::pow(10.0, (2 * radar.gain_dbi - radar.losses_db - 2 * excess_db) / 10);
}

/// Jamming power (W) in the radar's band, at its receiver:
///   J = EIRP Gr lambda^2 / ((4 pi R)^2 L A) b
/// with b the part of the jammer's band within the radar's: Br / Bj for a wider jammer at the same centre
/// frequency.
/// @see Skolnik, Radar Handbook, 3rd ed., chapter 24; D. L. Adamy, EW 101, 2001, chapter 9
EMSCAPE_HD inline double jammingPower_w(const RadarLink& radar, const JammerLink& jammer, double range_m,
                                        double excess_db = 0) {
  const double spread = wavelength_m(radar.frequency_hz) / (4 * kPi * range_m);
  const double in_band = bandOverlap(jammer.frequency_hz > 0 ? jammer.frequency_hz : radar.frequency_hz,
                                     jammer.bandwidth_hz, radar.frequency_hz, radar.bandwidth_hz);
  return jammer.eirp_w * spread * spread * in_band *
         std::pow(10.0, (jammer.radar_gain_dbi - jammer.polarization_loss_db -
                         jammer.radar_receive_losses_db - excess_db) /
                            10);
}

/// Noise power (W) of a bandwidth at a system's noise temperature.
EMSCAPE_HD inline double noisePower_w(double bandwidth_hz, double noise_temperature_k) {
  return kBoltzmann * noise_temperature_k * bandwidth_hz;
}

/// Noise temperature (K) of a receiver with a noise figure (dB, >= 0): T0 (F - 1).
EMSCAPE_HD inline double noiseTemperature_k(double noise_figure_db) {
  return kReferenceTemperature_K * (std::pow(10.0, noise_figure_db / 10) - 1);
}
/// Noise temperature (K) of antenna, line and receiver, referred to the antenna's terminals:
///   Ts = Ta + Tl (L - 1) + L T0 (F - 1)
/// @param line_loss_db  between antenna and receiver, >= 0
/// @see Blake, Radar Range-Performance Analysis, 1980, ch. 4
EMSCAPE_HD inline double systemNoiseTemperature_k(double antenna_temperature_k, double line_temperature_k,
                                                  double line_loss_db, double noise_figure_db) {
  const double line = std::pow(10.0, line_loss_db / 10);
  return antenna_temperature_k + line_temperature_k * (line - 1) + line * noiseTemperature_k(noise_figure_db);
}

/// Signal-to-noise ratio (dB) of one pulse.
EMSCAPE_HD inline double radarSnrDb(const RadarLink& radar, double rcs_m2, double range_m,
                                    double excess_db = 0) {
  return 10 * std::log10(echoPower_w(radar, rcs_m2, range_m, excess_db) /
                         noisePower_w(radar.bandwidth_hz, radar.noise_temperature_k));
}

/// Range (m) at which the signal-to-noise ratio of one pulse has fallen to a value, in free space.
EMSCAPE_HD inline double radarRange_m(const RadarLink& radar, double rcs_m2, double snr_db) {
  return std::pow(10.0, (radarSnrDb(radar, rcs_m2, 1) - snr_db) / 40);
}

}  // namespace emscape::emfield
