/// The pulses of a radar or jammer, and the figures that follow from them.
#pragma once

#include <optional>

#include "emscape/scenario/scan/scan.h"

namespace emscape::scenario {

/// A train of equal pulses.
struct Waveform {
  double prf_hz = 0;         ///< pulse repetition frequency, > 0
  double pulse_width_s = 0;  ///< as transmitted, before compression, > 0; shorter than 1 / prf_hz
  std::optional<double> instrumented_range_m;  ///< beyond which the radar does not look; none: no limit
  /// Nothing is detected beyond farthestDetection_m(), and less in blind ranges. False: wherever echoes are.
  bool limits_detection = true;

  /// Part (0..1] of the time in which the transmitter is on: mean over peak power.
  double dutyCycle() const { return prf_hz * pulse_width_s; }
  /// c / (2 PRF): echoes from beyond arrive after the next pulse.
  double unambiguousRange_m() const;
  /// The instrumented range, at most the unambiguous one.
  double farthestDetection_m() const;
  /// c tau / 2: echoes from nearer arrive while the pulse is transmitted.
  double minRange_m() const;
  /// Part (0..1) of the pulse's echo that arrives while the transmitter is on, and is lost.
  /// @param range_m  slant range, >= 0
  double eclipsedPart(double range_m) const;
  /// lambda PRF / 2: radial velocity (m/s) whose Doppler shift is the PRF.
  /// @see M. I. Skolnik, Introduction to Radar Systems, 2nd ed., section 4.2
  double firstBlindSpeed_mps(double frequency_hz) const;
};

/// Pulses on a target in one pass of the beam: PRF times beamwidth over the beam's angular rate, or PRF times
/// the shortest dwell of a list of dwells. None for a beam that does not scan.
/// @see M. I. Skolnik, Introduction to Radar Systems, 2nd ed., eq. (2.30): 15 for 300 Hz, 1.5 deg and 5 rpm
std::optional<double> hitsPerScan(const ScanSpec& scan, double beamwidth_az_deg, double prf_hz);

/// Time (s) between two looks of a scan at the same target: a turn, a sweep of a sector, all bars of a
/// raster, all dwells of a list. None for a beam that does not scan.
std::optional<double> scanPeriod_s(const ScanSpec& scan);

/// Planes in which a beam scans past a target, 0..2: one for rotate and sector, two for raster and
/// dwell_list.
int scannedPlanes(const ScanSpec& scan);

}  // namespace emscape::scenario
