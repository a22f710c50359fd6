/// Ray integral of a segment on which extinction and luminance are linear (partial pre-integration).
///
/// For a segment of length D with extinction tau and luminance L, index b at the back and f at the front:
///   zeta = exp(-D (tau_b + tau_f) / 2)
///   Psi  = (1 / D) int_0^D exp(-int_s^D tau(t) dt) ds, s from the back to the front
///   I    = I_behind zeta + L_b (Psi - zeta) + L_f (1 - Psi)
/// Psi depends only on tau_b D and tau_f D, not on the transfer function.
/// @see K. D. Moreland, Fast High Accuracy Volume Rendering, PhD thesis, University of New Mexico, 2004
#pragma once

#include <cmath>
#include <vector>

#include "emscape/base/host_device.h"

namespace emscape::render {

constexpr double kSqrtPi = 1.7724538509055160273;

/// exp(x^2) erfc(x). @param x  >= 0 @accuracy relative 1e-13
EMSCAPE_HD inline double scaledErfc(double x) {
  constexpr double kFar = 5;
  if (x < kFar) return exp(x * x) * erfc(x);
  // Laplace's continued fraction, from its end.
  constexpr int kTerms = 40;
  double tail = x;
  for (int n = kTerms; n >= 1; --n) tail = x + 0.5 * n / tail;
  return 1 / (kSqrtPi * tail);
}

/// Dawson's integral exp(-x^2) int_0^x exp(t^2) dt. @param x  >= 0 @accuracy relative 1e-13
EMSCAPE_HD inline double dawson(double x) {
  constexpr double kFar = 7;
  const double squared = x * x;
  if (x < kFar) {
    // x exp(-x^2) sum x^2n / (n! (2n + 1)): all terms are positive.
    double term = 1, sum = 0;
    for (int n = 0; n < 300; ++n) {
      const double added = term / (2 * n + 1);
      sum += added;
      if (added < 1e-17 * sum) break;
      term *= squared / (n + 1);
    }
    return x * exp(-squared) * sum;
  }
  // Asymptotic: 1 / (2x) sum (2n - 1)!! / (2 x^2)^n, up to its smallest term.
  double term = 1, sum = 1;
  for (int n = 1; n < 50; ++n) {
    const double next = term * (2 * n - 1) / (2 * squared);
    if (next > term || next < 1e-17) break;
    term = next;
    sum += term;
  }
  return sum / (2 * x);
}

/// Psi by quadrature; for optically thin segments, where the closed form's differences cancel.
EMSCAPE_HD inline double shallowPsi(double back, double front) {
  // Ten-point Gauss-Legendre rule on -1..1: half of its symmetric nodes and weights.
  constexpr double kNodes[] = {0.14887433898163121089, 0.43339539412924719080, 0.67940956829902440623,
                               0.86506336668898451073, 0.97390652851717172008};
  constexpr double kWeights[] = {0.29552422471475287017, 0.26926671930999635509, 0.21908636251598204400,
                                 0.14945134915058059315, 0.06667134430868813759};
  double sum = 0;
  for (int n = 0; n < 5; ++n) {
    for (int side = 0; side < 2; ++side) {
      const double x = 0.5 + (side == 0 ? 0.5 : -0.5) * kNodes[n];
      sum += kWeights[n] * exp(-x * (front + 0.5 * (back - front) * x));
    }
  }
  return 0.5 * sum;
}

/// Psi in closed form. @param back, front  tau_b D and tau_f D, >= 0, finite @accuracy 1e-12
EMSCAPE_HD inline double psi(double back, double front) {
  constexpr double kShallow = 1;
  if (fmax(back, front) < kShallow) return shallowPsi(back, front);
  const double depth = 0.5 * (back + front);
  const double zeta = exp(-depth);
  const double apart = fabs(back - front);
  // For smaller differences the closed form equals that of equal ends to all digits.
  if (apart < 1e-13 * depth) return -expm1(-depth) / depth;
  const double k = 1 / sqrt(2 * apart);
  return back > front ? kSqrtPi * k * (scaledErfc(k * front) - zeta * scaledErfc(k * back))
                      : 2 * k * (dawson(k * front) - zeta * dawson(k * back));
}

/// Psi tabulated over gamma = tau D / (1 + tau D) of both ends, with bilinear interpolation.
struct PsiLookup {
  static constexpr int kEntries = 512;  ///< along each axis
  /// Max tau D of the lookup. Beyond it the closed form is used: Psi falls like a square root, and bilinear
  /// interpolation errs by up to 1e-2 near gamma = 1.
  static constexpr double kMaxDepth = 8;
  /// Below this tau D the first terms of the series are used; error < 4e-7.
  static constexpr double kSmallDepth = 0.02;

  /// kEntries x kEntries, gamma of the back fastest; null: Psi in closed form for all arguments.
  const float* values = nullptr;

  /// Psi for any arguments of psi(). @accuracy with a table 5e-6
  EMSCAPE_HD double operator()(double back, double front) const {
    const double greater = fmax(back, front);
    if (values != nullptr && greater < kSmallDepth) {
      // With q = front x + (back - front) x^2 / 2: the mean of 1 - q + q^2 / 2.
      const double apart = back - front;
      return 1 - front / 3 - back / 6 + 0.5 * (front * front / 3 + front * apart / 4 + apart * apart / 20);
    }
    if (values == nullptr || greater > kMaxDepth) return psi(back, front);
    return interpolated(back / (1 + back), front / (1 + front));
  }
  /// Bilinear interpolation only. @param gamma_back, gamma_front  0..1
  EMSCAPE_HD double interpolated(double gamma_back, double gamma_front) const {
    const double x = gamma_back * (kEntries - 1), y = gamma_front * (kEntries - 1);
    const int i = x < kEntries - 2 ? static_cast<int>(x) : kEntries - 2;
    const int j = y < kEntries - 2 ? static_cast<int>(y) : kEntries - 2;
    const double u = x - i, v = y - j;
    const float* const entry = values + (j * kEntries + i);
    const double low = static_cast<double>(entry[0]) * (1 - u) + static_cast<double>(entry[1]) * u;
    const double high =
        static_cast<double>(entry[kEntries]) * (1 - u) + static_cast<double>(entry[kEntries + 1]) * u;
    return low * (1 - v) + high * v;
  }
};

/// Owner of Psi's table.
class PsiTable {
 public:
  PsiTable();
  /// The process-wide table, computed at the first call.
  static const PsiTable& shared();

  PsiLookup lookup() const { return {values_.data()}; }

 private:
  std::vector<float> values_;
};

}  // namespace emscape::render
