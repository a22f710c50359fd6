#include "emfield/radar/detection_losses.h"

#include <algorithm>
#include <cmath>

#include "emfield/radar/receiver.h"
#include "emscape/base/units.h"
#include "emscape/scenario/model/waveform.h"

namespace emscape::emfield {
namespace {

constexpr double kReferencePd = 0.5;
/// CFAR: with more pulses the loss no longer changes.
constexpr int kMaxCfarPulses = 10000;

/// The argument between `low` and `high` at which a decreasing function reaches a value, by geometric
/// bisection.
template <class Function>
double whereItFallsTo(double value, double low, double high, const Function& function) {
  while (high / low - 1 > 1e-13) {
    const double middle = std::sqrt(low * high);
    (function(middle) > value ? low : high) = middle;
  }
  return std::sqrt(low * high);
}

/// P(Y > a Z) for sums Y of `pulses` and Z of cells * pulses exponential variables of mean 1.
double exceedance(double a, int pulses, double cells) {
  const double all = cells * pulses;
  const double log_ratio = std::log(a) - std::log1p(a);
  double log_term = -all * std::log1p(a), sum = 0;
  for (int k = 0; k < pulses; ++k) {
    sum += std::exp(log_term);
    log_term += std::log((all + k) / (k + 1)) + log_ratio;
  }
  return sum;
}

/// Probability of at least `needed` of n independent events of probability p.
double atLeast(int needed, int n, double p) {
  if (p >= 1) return 1;
  double log_choices = 0;
  for (int k = 1; k <= needed; ++k) log_choices += std::log(double(n - needed + k) / k);
  double log_term = log_choices + needed * std::log(p) + (n - needed) * std::log1p(-p);
  const double log_odds = std::log(p) - std::log1p(-p);
  double sum = 0;
  for (int k = needed; k <= n; ++k) {
    const double term = std::exp(log_term);
    sum += term;
    if (k > n * p && term < 1e-18 * sum) break;
    log_term += std::log(double(n - k) / (k + 1)) + log_odds;
  }
  return std::min(sum, 1.0);
}

/// The probability of a single event for which at least `needed` of n events have a given probability.
double perEvent(int needed, int n, double probability) {
  return 1 / whereItFallsTo(probability, 1, 1e300,
                            [&](double inverse) { return atLeast(needed, n, 1 / inverse); });
}

}  // namespace

double beamShapeLossDb(scenario::BeamShapeLoss rule, int planes) {
  switch (rule) {
    case scenario::BeamShapeLoss::none:
      return 0;
    case scenario::BeamShapeLoss::blake:
      return 1.6 * planes;
    case scenario::BeamShapeLoss::barton:
      return planes * ratioToDb(std::sqrt(8 * std::log(2.0) / kPi));
  }
  return 0;
}

double cfarLossDb(const Detector& detector, int cells) {
  Detector ideal = detector;
  ideal.pulses = std::min(detector.pulses, kMaxCfarPulses);
  const auto multiplier = [&](double probability) {
    return whereItFallsTo(probability, 1e-12, 1e18,
                          [&](double a) { return exceedance(a, ideal.pulses, cells); });
  };
  const double needed = multiplier(ideal.false_alarm_probability) / multiplier(kReferencePd) - 1;
  const double of_false_alarms = detectionThreshold(ideal);
  ideal.false_alarm_probability = kReferencePd;
  return ratioToDb(needed / (of_false_alarms / detectionThreshold(ideal) - 1));
}

double binaryIntegrationLossDb(const Detector& detector, int needed) {
  const Detector sum{Swerling::steady, detector.pulses, detector.false_alarm_probability};
  const Detector one{Swerling::steady, 1, 0};
  const double threshold = -std::log(perEvent(needed, sum.pulses, sum.false_alarm_probability));
  const double wanted = perEvent(needed, sum.pulses, kReferencePd);
  const double inverse_snr = whereItFallsTo(
      wanted, 1e-6, 1e9, [&](double inverse) { return detectionProbability(one, threshold, 1 / inverse); });
  return -ratioToDb(inverse_snr) - requiredSnrDb(sum, kReferencePd);
}

DetectionLosses detectionLosses(const scenario::Emitter& radar) {
  const scenario::RadarReceiver& receiver = radar.receiver;
  const Detector detector = detectorOf(receiver);
  DetectionLosses losses;
  losses.beam_shape_db = beamShapeLossDb(receiver.beam_shape_loss, scenario::scannedPlanes(radar.scan));
  // For a probability of false alarm of 1/2 no signal is needed, and there is no ratio.
  if (detector.false_alarm_probability >= kReferencePd) return losses;
  if (receiver.cfar_cells > 0) losses.cfar_db = cfarLossDb(detector, receiver.cfar_cells);
  if (receiver.binary_threshold > 0)
    losses.binary_db = binaryIntegrationLossDb(detector, receiver.binary_threshold);
  return losses;
}

}  // namespace emscape::emfield
