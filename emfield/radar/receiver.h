/// Converts a scenario's radars, jammers and receivers to the inputs of the radar equation and of detection.
#pragma once

#include <memory>

#include "emfield/radar/detection.h"
#include "emfield/radar/equation.h"
#include "emfield/radar/look.h"
#include "emscape/scenario/model/emitter.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::emfield {

/// The radar with an isotropic antenna and with all losses and gains of its chain: the transmitter's
/// (Emitter::losses_db), the receiver's and the processing's.
RadarLink radarLinkOf(const scenario::Emitter& radar);

Detector detectorOf(const scenario::RadarReceiver& receiver);

/// Root (m2/W) of the factor c of SNR = c S^2, with S the radar's power density at its target: with P G F^2 /
/// (4 pi R^2 Lt) = S the radar equation is SNR = S^2 lambda^2 sigma Lt / (4 pi P k Ts B Lr).
double echoRoot_m2_w(const scenario::Emitter& radar);

/// Loss (dB) by the mismatch of a jammer's polarisation at the radar's antenna, at most the isolation of its
/// cross polarisation.
double polarizationLossDb(const scenario::Emitter& radar, const scenario::Emitter& jammer);
/// Jamming over noise (m2/W) at the radar's receiver for a power density of 1 W/m2 that arrives on its
/// boresight; 0 for a jammer outside its band.
double jammingToNoise_m2_w(const scenario::Emitter& radar, const scenario::Emitter& jammer);

/// Signal-to-noise ratio (dB) of one pulse, including detection losses, for which a target is detected, by
/// the radar's method of detection, with a probability of 1/2 (3/4 if the probability of false alarm is 1/2).
double requiredSnrDb(const scenario::Emitter& radar);
/// The probability that requiredSnrDb() refers to.
double requiredProbability(const scenario::RadarReceiver& receiver);

/// What clutter counts more than noise (dB) in a detection, >= 0, if fewer of its samples are independent
/// than pulses are integrated: the ratio of the signal-to-noise ratios per pulse that detection takes with as
/// many pulses as there are independent samples and with all pulses.
/// @see D. K. Barton, Radar Equations for Modern Radar, 2013, ch. 3: clutter detectability factor
double correlationLossDb(const scenario::Emitter& radar);

/// Signal-to-jammer ratio (dB) at which the radar burns through, after processing.
double requiredSignalToJammerDb(const scenario::Emitter& radar);

/// Received power (W) of a receiver for a power density of 1 W/m2 of an emitter whose signal is within its
/// band.
double inBandArea_m2(const scenario::Emitter& emitter, const scenario::ReceiverProfile& receiver);
/// Part (0..1) of an emitter's signal within a receiver's band, which is that of the signal if its width is
/// 0.
/// @param tuned_hz  middle of the band; 0: the emitter's frequency
double partInBand(const scenario::Emitter& emitter, double tuned_hz, double width_hz);
/// Received power (W) of a receiver for a power density of 1 W/m2 of an emitter: the product of both.
double receivingArea_m2(const scenario::Emitter& emitter, const scenario::ReceiverProfile& receiver);

/// The target of maps, volumes and vertical diagrams, where a scenario has others in 'targets', which they do
/// not use: "1 m2 ('target_rcs_m2' of each radar), ; 'plane' of 'targets' has another, for
/// link and exposure"; else empty.
std::string targetText(const scenario::Scenario& scenario);

/// The curve of a radar's detector. Radars with the same detector share a curve while it is in use.
/// Thread-safe.
std::shared_ptr<const DetectionCurve> detectionCurveOf(const scenario::Emitter& radar);

/// Noise (W) of a receiver after its line's losses, the reference point of received powers.
/// @param receiver  with a noise figure and a bandwidth
double receiverNoise_w(const scenario::ReceiverProfile& receiver);

/// Minimum power (W) after the line's losses that a receiver intercepts: its sensitivity, or its required
/// ratio over noise; the larger if it has both.
/// @param receiver  with a sensitivity, or a required ratio and noise
double interceptThreshold_w(const scenario::ReceiverProfile& receiver);

/// The radar's look at targets; `held` for RadarLook::scan, and for a fixed scan of an antenna that is not an
/// array.
RadarLook lookOf(const scenario::Emitter& radar, scenario::RadarAim look);

}  // namespace emscape::emfield
