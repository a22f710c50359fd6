/// Losses of a radar's detection relative to an ideal detector of `pulses` pulses at the beam's peak.
#pragma once

#include "emfield/radar/detection.h"
#include "emscape/scenario/model/emitter.h"

namespace emscape::emfield {

/// Additional signal-to-noise ratio (dB) required for detection, by cause; each >= 0.
struct DetectionLosses {
  double beam_shape_db = 0;
  double cfar_db = 0;
  double binary_db = 0;  ///< M-of-N integration instead of the sum of all pulses

  double total_db() const { return beam_shape_db + cfar_db + binary_db; }
};

/// The losses of a radar, as stated for its receiver; 0 if not stated.
DetectionLosses detectionLosses(const scenario::Emitter& radar);

/// Beam-shape loss (dB): loss of pulses that a scanning beam receives off its peak. blake: 1.6 dB per plane;
/// L. V. Blake, The effective number of pulses per beamwidth for a scanning radar, Proc. IRE 41 (1953): 0.47
/// of the pulses within the half-power beamwidth count, 5 log(1 / 0.47) dB. barton: (8 ln 2 / pi)^(1/2), 1.23
/// dB, per plane: a Gaussian beam, dense pulses counted between the one-way half-power points; D. K. Barton
/// and S. A. Leonov, Radar Technology Encyclopedia, 1998, "loss, beamshape": 1.2 dB.
/// @param planes  scanned, 0..2
double beamShapeLossDb(scenario::BeamShapeLoss rule, int planes);

/// Loss (dB) of a cell-averaging CFAR detector at a probability of detection of 1/2. Exact for Swerling's
/// case 2, and for case 1 with one pulse; also used for the other cases.
///   Pfa = sum over k < N of C(M N + k - 1, k) a^k / (1 + a)^(M N + k),
/// and Pd the same with a / (1 + S): N pulses, M reference cells, threshold a times the cells' sum.
/// @param cells  M, >= 1
/// @see H. M. Finn, R. S. Johnson, RCA Review 29 (1968), pp. 414-464, for N = 1; derived here, not copied
double cfarLossDb(const Detector& detector, int cells);

/// Loss (dB) at a probability of detection of 1/2, for a steady target, of a detector that decides on each
/// pulse and declares a target from `needed` detections in Detector::pulses, relative to the sum of the
/// pulses.
/// @param needed  1..Detector::pulses
/// @see M. Schwartz, IRE Trans. IT-2 (1956), p. 135 (citation not checked); derived here
double binaryIntegrationLossDb(const Detector& detector, int needed);

}  // namespace emscape::emfield
