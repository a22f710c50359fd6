/// A scenario's radars, jammers and receivers in the terms of the radar equation and of detection.
#pragma once

#include <memory>

#include "emfield/radar/detection.h"
#include "emfield/radar/equation.h"
#include "emfield/radar/look.h"
#include "emscape/scenario/emitter.h"
#include "emscape/scenario/scenario.h"

namespace emscape::emfield {

/// The radar with an isotropic antenna, with all losses and gains of its chain once: the transmitter's
/// (Emitter::losses_db), the receiver's and the processing's.
RadarLink radarLinkOf(const scenario::Emitter& radar);

Detector detectorOf(const scenario::RadarReceiver& receiver);

/// Root (m2/W) of the factor c of SNR = c S^2, with S the power density that the radar makes at its target:
/// with P G F^2 / (4 pi R^2 Lt) = S the radar equation is SNR = S^2 lambda^2 sigma Lt / (4 pi P k Ts B Lr).
double echoRoot_m2_w(const scenario::Emitter& radar);

/// Jamming over noise (m2/W) at the radar's receiver for a power density of 1 W/m2 that comes in on its
/// boresight; 0 for a jammer outside its band.
double jammingToNoise_m2_w(const scenario::Emitter& radar, const scenario::Emitter& jammer);

/// Signal-to-noise ratio (dB) of one pulse, its detection losses included, for which a target is detected
/// with a probability of 1/2 (3/4 if the probability of false alarm is 1/2).
double requiredSnrDb(const scenario::Emitter& radar);
/// The probability for which requiredSnrDb() is.
double requiredProbability(const scenario::RadarReceiver& receiver);

/// Signal-to-jammer ratio (dB) at which the radar burns through, after processing.
double requiredSignalToJammerDb(const scenario::Emitter& radar);

/// Received power (W) of a receiver for a power density of 1 W/m2 of an emitter.
double receivingArea_m2(const scenario::Emitter& emitter, const scenario::ReceiverProfile& receiver);

/// The curve of a radar's detector. Radars with the same detector share one as long as somebody holds it.
/// Threads may call it.
std::shared_ptr<const DetectionCurve> detectionCurveOf(const scenario::Emitter& radar);

/// Noise (W) of a receiver behind its line's losses, where received powers are.
/// @param receiver  with a noise figure and a bandwidth
double receiverNoise_w(const scenario::ReceiverProfile& receiver);

/// Smallest power (W) behind the line's losses that a receiver intercepts: its sensitivity, and its required
/// ratio to noise; the larger of both if it has both.
/// @param receiver  with a sensitivity, or a required ratio and noise
double interceptThreshold_w(const scenario::ReceiverProfile& receiver);

/// The radar's look at targets; `held` for RadarLook::scan, and for a fixed scan of an antenna that is no
/// array.
RadarLook lookOf(const scenario::Emitter& radar, scenario::RadarLook look);

}  // namespace emscape::emfield
