#include "propagation/parabolic_equation/march/march_grid.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/error.h"
#include "propagation/parabolic_equation/air/refractivity.h"

namespace emscape::propagation {
namespace {

constexpr double kMinRangeStep_m = 50;
constexpr double kTrappingStep_m = 200;  ///< at kTrappingFrequency_hz
constexpr double kTrappingFrequency_hz = 1e10;
constexpr double kThickDuct_m = 80;  ///< lower ducts have steeper gradients, and proportionally shorter steps
constexpr double kPlainStep_m = 500;

void require(const ModelLimit& limit, double value) {
  if (!limit.holds(value)) {
    throw Error(ErrorCode::bad_input, outsideMessage(limit, value));
  }
}

void requirePositive(const char* what, double value, const char* unit) {
  if (value > 0 && std::isfinite(value)) return;
  throw Error(ErrorCode::bad_input, fmt::format("{} {} {} is not above 0", what, value, unit));
}

/// Min height of the domain: in standard air its absorber is eight vertical wavelengths thick for the ray
/// that grazes the earth. A thinner absorber reflects that ray, and the reflections dominate far beyond the
/// horizon: with three wavelengths -2 dB instead of -80 dB (10 GHz, 60 km).
double grazingTop_m(double wavelength_m) {
  constexpr double kVerticalWavelengths = 8;
  const double sine_per_root_m = std::sqrt(2e-6 * kStandardGradient_m);  // of the ray at a height
  return std::pow(kVerticalWavelengths * wavelength_m / (kPeAbsorberPart * sine_per_root_m), 2.0 / 3);
}

}  // namespace

void setAbsorber(MarchGrid& grid, double absorber_m) {
  grid.absorber_m = absorber_m > 0 ? absorber_m : kPeAbsorberPart * grid.top_m;
  grid.absorber_per_m = 90 * 4 * std::min(grid.maxSine(), 1.0) / (17.4 * grid.absorber_m);
}

double absorberStep_m(const MarchGrid& grid) {
  return grid.absorber_m / (4 * std::tan(std::asin(std::min(0.99, grid.maxSine()))));
}

void checkGrid(const MarchGrid& grid) {
  require(kPeFrequency, grid.frequency_hz);
  requirePositive("height of the domain", grid.top_m, "m");
  requirePositive("range step", grid.range_step_m, "m");
  const int n = grid.intervals;
  if (n < 8 || n > kPeMaxIntervals || (n & (n - 1)) != 0) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{} height steps; expected a power of two in 8 .. {}", n, kPeMaxIntervals));
  }
  if (!(grid.absorber_m >= 0 && grid.absorber_m < grid.top_m && grid.absorber_per_m >= 0)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("absorber of {} m and {} / m; expected less than the domain's {} m, and "
                            "no growth",
                            grid.absorber_m, grid.absorber_per_m, grid.top_m));
  }
}

AutomaticGrid automaticGrid(const MarchNeeds& needs) {
  require(kPeFrequency, needs.frequency_hz);
  require(kPeAngle, needs.max_angle_rad);
  requirePositive("largest height", needs.max_height_m, "m");
  AutomaticGrid found;
  MarchGrid& grid = found.grid;
  grid.frequency_hz = needs.frequency_hz;

  const double wavelength = wavelength_m(needs.frequency_hz);
  const double sine = std::sin(needs.max_angle_rad);
  // the source fills 0.6 of the band, which includes the wanted angle
  const double largest_step_m = kPeEvenBand * wavelength / (2 * sine);
  const double wanted_top_m = needs.max_height_m / kPeUsable / (1 - kPeAbsorberPart);
  // thirty vertical wavelengths of a ray at a tenth of the band in the absorber
  const double absorber_top_m = 30 * largest_step_m * 2 / kPeAbsorberPart / 10;
  const double least_top_m = std::max({wanted_top_m, absorber_top_m, grazingTop_m(wavelength)});
  const double wanted_intervals = least_top_m / largest_step_m;
  if (wanted_intervals > kPeMaxIntervals) {
    const double affordable =
        radToDeg(std::asin(std::min(1.0, kPeEvenBand * wavelength * kPeMaxIntervals / (2 * wanted_top_m))));
    throw Error(ErrorCode::bad_input,
                fmt::format("{:.0f} height steps for {:.4g} m at {:.4g} degrees; at most {}, which "
                            "afford {:.3g} degrees",
                            wanted_intervals, needs.max_height_m, radToDeg(needs.max_angle_rad),
                            kPeMaxIntervals, affordable));
  }
  found.wanted_intervals = wanted_intervals;
  grid.intervals = 1 << std::max(8, int(std::ceil(std::log2(wanted_intervals))));
  grid.top_m = grid.intervals * largest_step_m;
  setAbsorber(grid);
  found.choices.push_back(
      {"height of the domain",
       fmt::format(
           "{:.4g} m: {:.4g} m wanted, below {} of what the absorber leaves, and at least {:.3g} m for the "
           "rays that graze the earth; {} steps, a power of two",
           grid.top_m, needs.max_height_m, kPeUsable, grazingTop_m(wavelength), grid.intervals)});
  found.choices.push_back(
      {"height step", fmt::format("{:.4g} m: {} wavelength / (2 sin {:.3g} degrees)", grid.heightStep_m(),
                                  kPeEvenBand, radToDeg(needs.max_angle_rad))});
  found.choices.push_back(
      {"absorber", fmt::format("{:.4g} m with {:.3g} / m at the top: 90 dB at the largest angle",
                               grid.absorber_m, grid.absorber_per_m)});

  struct Bound {
    double step_m;
    const char* reason;
  };
  std::vector<Bound> bounds = {{kPlainStep_m, "error of the splitting in air that does not trap"},
                               {absorberStep_m(grid), "a quarter of the absorber's length"}};
  if (needs.traps) {
    bounds.push_back({kTrappingStep_m * std::sqrt(kTrappingFrequency_hz / needs.frequency_hz) *
                          std::min(1.0, needs.trapping_top_m / kThickDuct_m),
                      "error of the splitting where a layer traps"});
  }
  if (needs.post_spacing_m > 0) bounds.push_back({needs.post_spacing_m, "the terrain's posts"});
  const Bound tightest = *std::min_element(
      bounds.begin(), bounds.end(), [](const Bound& a, const Bound& b) { return a.step_m < b.step_m; });
  grid.range_step_m = std::max(kMinRangeStep_m, tightest.step_m);
  found.choices.push_back(
      {"range step", fmt::format("{:.4g} m: {}", grid.range_step_m,
                                 tightest.step_m < kMinRangeStep_m ? "the least step" : tightest.reason)});
  if (needs.post_spacing_m > 0) grid.slope_part = kPeSlopePart;
  // Deep shadows behind ridges are filled by steep rays of less power than halving neglects.
  grid.halving = needs.post_spacing_m <= 0;
  return found;
}

}  // namespace emscape::propagation
