#include "emfield/clutter/mti.h"

#include <cmath>
#include <vector>

#include "emscape/base/units.h"

namespace emscape::emfield {
namespace {

using scenario::MtiKind;

std::vector<double> binomialWeights(int pulses) {
  std::vector<double> weights{1};
  for (int n = 1; n < pulses; ++n) {
    const double ratio = static_cast<double>(pulses - n) / n;
    weights.push_back(-weights.back() * ratio);
  }
  return weights;
}

/// Samples at n = 0..N-1 of the window of period N.
std::vector<double> blackmanHarrisWeights(int pulses) {
  std::vector<double> weights;
  for (int n = 0; n < pulses; ++n) {
    const double angle = 2 * kPi * (n + 0.5) / pulses;
    weights.push_back(0.35875 - 0.48829 * std::cos(angle) + 0.14128 * std::cos(2 * angle) -
                      0.01168 * std::cos(3 * angle));
  }
  return weights;
}

/// sum of w_i w_j rho(i - j) cos((i - j) phase)
double residue(const std::vector<double>& weights, double spread_in_prf, double phase_rad) {
  const int count = static_cast<int>(weights.size());
  double sum = 0;
  for (int lag = 0; lag < count; ++lag) {
    double products = 0;
    for (int i = 0; i + lag < count; ++i) products += weights[i] * weights[i + lag];
    const double turn = kPi * spread_in_prf * lag;
    sum += (lag == 0 ? 1 : 2) * products * std::exp(-2 * turn * turn) * std::cos(phase_rad * lag);
  }
  return std::max(sum, 0.0);
}

double sumOfSquares(const std::vector<double>& weights) {
  double sum = 0;
  for (const double weight : weights) sum += weight * weight;
  return sum;
}

}  // namespace

double MtiFilter::response(std::optional<double> radial_speed_mps) const {
  if (mti.kind == MtiKind::pulse_doppler || !radial_speed_mps) return 1;
  const std::vector<double> weights = binomialWeights(mti.pulses);
  const double phase_rad = 4 * kPi * *radial_speed_mps / wavelength_m(frequency_hz) / prf_hz;
  return std::pow(2 * std::sin(phase_rad / 2), 2 * (mti.pulses - 1)) / sumOfSquares(weights);
}

double MtiFilter::improvement(double spread_mps, std::optional<double> radial_speed_mps) const {
  const double hz_per_mps = 2 / wavelength_m(frequency_hz);
  const double spread_in_prf = spread_mps * hz_per_mps / prf_hz;
  double clutter_over_echo = 0;
  if (mti.kind == MtiKind::canceller) {
    const std::vector<double> weights = binomialWeights(mti.pulses);
    clutter_over_echo = residue(weights, spread_in_prf, 0) / sumOfSquares(weights);
  } else {
    const std::vector<double> weights = blackmanHarrisWeights(mti.pulses);
    double sum = 0;
    for (const double weight : weights) sum += weight;
    const double phase_rad = radial_speed_mps ? 2 * kPi * *radial_speed_mps * hz_per_mps / prf_hz : kPi;
    clutter_over_echo = residue(weights, spread_in_prf, phase_rad) / (sum * sum);
  }
  if (mti.improvement_limit_db) clutter_over_echo += dbToRatio(-*mti.improvement_limit_db);
  return 1 / clutter_over_echo;
}

}  // namespace emscape::emfield
