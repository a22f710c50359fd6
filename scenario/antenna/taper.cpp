#include "scenario/antenna/taper.h"

#include <cmath>

#include "emscape/base/units.h"
#include "scenario/antenna/tables.h"

namespace emscape::scenario {
namespace {

/// sin(pi u) / (pi u).
double sinc(double u) {
  const double x = kPi * u;
  return std::abs(x) < 1e-8 ? 1.0 : std::sin(x) / x;
}

/// Array factor sin(N x) / (N sin x) of N uniformly weighted elements.
double evenArray(int elements, double x) {
  const double sine = std::sin(x);
  // At the main and the grating lobes the limit is the ratio of the derivatives.
  if (std::abs(sine) < 1e-9) return std::cos(elements * x) / std::cos(x);
  return std::sin(elements * x) / (elements * sine);
}

/// Taylor's coefficients F_1 .. F_(n-bar - 1) of the distribution: its pattern at the whole numbers.
std::vector<double> taylorHarmonics(double side_lobe_db) {
  const double a = std::acosh(std::pow(10.0, -side_lobe_db / 20)) / kPi;
  const int n_bar = static_cast<int>(std::ceil(2 * a * a + 0.5));
  const double dilation2 = n_bar * n_bar / (a * a + (n_bar - 0.5) * (n_bar - 0.5));
  std::vector<double> harmonics;
  for (int m = 1; m < n_bar; ++m) {
    double numerator = 1, denominator = 1;
    for (int n = 1; n < n_bar; ++n) {
      numerator *= 1 - m * m / (dilation2 * (a * a + (n - 0.5) * (n - 0.5)));
      if (n != m) denominator *= 1 - double(m * m) / (n * n);
    }
    harmonics.push_back((m % 2 == 1 ? 0.5 : -0.5) * numerator / denominator);
  }
  return harmonics;
}

}  // namespace

Taper::Taper(TaperKind kind, double side_lobe_db) : kind_(kind) {
  if (kind == TaperKind::taylor) {
    requireWithin("taper_side_lobe_db", side_lobe_db, -60, -15, "dB");
    harmonics_ = taylorHarmonics(side_lobe_db);
  }
  // Each of these patterns falls monotonically from 1 at u = 0 beyond half power, which it reaches before
  // 1.5.
  double inside = 0, outside = 1.5;
  for (int i = 0; i < 60; ++i) {
    const double middle = (inside + outside) / 2;
    (pattern(middle) > std::sqrt(0.5) ? inside : outside) = middle;
  }
  half_power_ = (inside + outside) / 2;
}

double Taper::pattern(double u) const {
  if (kind_ == TaperKind::cosine) {
    // cos(pi u) / (1 - 4 u^2), as two shifted uniform apertures, which avoids 0 / 0 at u = 1/2.
    return kPi / 4 * (sinc(u - 0.5) + sinc(u + 0.5));
  }
  double sum = sinc(u);
  for (std::size_t m = 1; m <= harmonics_.size(); ++m) {
    sum += harmonics_[m - 1] * (sinc(u - double(m)) + sinc(u + double(m)));
  }
  return sum;
}

double Taper::arrayPattern(int elements, double phase_rad) const {
  if (kind_ == TaperKind::uniform) return evenArray(elements, phase_rad);
  if (kind_ == TaperKind::cosine) {
    const double shift = kPi / (2.0 * elements);
    return (evenArray(elements, phase_rad - shift) + evenArray(elements, phase_rad + shift)) /
           (2 * evenArray(elements, shift));
  }
  double sum = evenArray(elements, phase_rad), at_maximum = 1;
  for (std::size_t m = 1; m <= harmonics_.size(); ++m) {
    const double shift = kPi * double(m) / elements;
    sum +=
        harmonics_[m - 1] * (evenArray(elements, phase_rad - shift) + evenArray(elements, phase_rad + shift));
    at_maximum += 2 * harmonics_[m - 1] * evenArray(elements, shift);
  }
  return sum / at_maximum;
}

double Taper::arrayEfficiency(int elements) const {
  double sum = 0, sum_of_squares = 0;
  for (int i = 0; i < elements; ++i) {
    const double w = weight((i - (elements - 1) / 2.0) / elements);
    sum += w;
    sum_of_squares += w * w;
  }
  return sum * sum / (elements * sum_of_squares);
}

double Taper::weight(double x) const {
  if (kind_ == TaperKind::cosine) return std::cos(kPi * x);
  double sum = 1;
  for (std::size_t m = 1; m <= harmonics_.size(); ++m) {
    sum += 2 * harmonics_[m - 1] * std::cos(2 * kPi * double(m) * x);
  }
  return sum;
}

}  // namespace emscape::scenario
