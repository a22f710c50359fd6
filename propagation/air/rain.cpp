#include "propagation/air/rain.h"

#include <algorithm>

namespace emscape::propagation {
namespace {

/// One bell of a fit over x = log10(f in GHz): a exp(-((x - b) / c)^2).
struct Bell {
  double a, b, c;
};

/// Sum of bells and a line, m x + c.
template <int kCount>
double fit(const Bell (&bells)[kCount], double m, double c, double x) {
  double sum = m * x + c;
  for (const Bell& bell : bells) {
    const double t = (x - bell.b) / bell.c;
    sum += bell.a * std::exp(-t * t);
  }
  return sum;
}

// P.838-3 tables 1 to 4.
constexpr Bell kHorizontalK[] = {{-5.33980, -0.10008, 1.13098},
                                 {-0.35351, 1.26970, 0.45400},
                                 {-0.23789, 0.86036, 0.15354},
                                 {-0.94158, 0.64552, 0.16817}};
constexpr Bell kVerticalK[] = {{-3.80595, 0.56934, 0.81061},
                               {-3.44965, -0.22911, 0.51059},
                               {-0.39902, 0.73042, 0.11899},
                               {0.50167, 1.07319, 0.27195}};
constexpr Bell kHorizontalAlpha[] = {{-0.14318, 1.82442, -0.55187},
                                     {0.29591, 0.77564, 0.19822},
                                     {0.32177, 0.63773, 0.13164},
                                     {-5.37610, -0.96230, 1.47828},
                                     {16.1721, -3.29980, 3.43990}};
constexpr Bell kVerticalAlpha[] = {{-0.07771, 2.33840, -0.76284},
                                   {0.56727, 0.95545, 0.54039},
                                   {-0.20238, 1.14520, 0.26809},
                                   {-48.2991, 0.791669, 0.116226},
                                   {48.5833, 0.791459, 0.116479}};

}  // namespace

RainCoefficients<double> rainCoefficients(double frequency_hz, double elevation_rad, double tilt_rad) {
  const double x = std::log10(std::clamp(frequency_hz / 1e9, kRainFrequency.min, kRainFrequency.max));
  const double k_h = std::pow(10, fit(kHorizontalK, -0.18961, 0.71147, x));  // eq. (2)
  const double k_v = std::pow(10, fit(kVerticalK, -0.16398, 0.63297, x));
  const double alpha_h = fit(kHorizontalAlpha, 0.67849, -1.95537, x);  // eq. (3)
  const double alpha_v = fit(kVerticalAlpha, -0.053739, 0.83433, x);
  const double level = std::cos(elevation_rad);
  const double weight = level * level * std::cos(2 * tilt_rad);
  const double k = (k_h + k_v + (k_h - k_v) * weight) / 2;  // eq. (4)
  const double alpha =
      (k_h * alpha_h + k_v * alpha_v + (k_h * alpha_h - k_v * alpha_v) * weight) / (2 * k);  // eq. (5)
  return {k, alpha};
}

}  // namespace emscape::propagation
