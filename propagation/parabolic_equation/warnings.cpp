#include "propagation/parabolic_equation/warnings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "emscape/base/work.h"
#include "propagation/parabolic_equation/march/march_step.h"

namespace emscape::propagation {
namespace {

double percentOf(unsigned warnings, int shift) {
  return (warnings >> shift & ((1u << kPePartBits) - 1)) / 10.0;
}

/// Fraction of the steps of all azimuths that are marched whose ground is taken as steps of a staircase.
double staircasePartOf(const PePlan& plan, const AzimuthMarch& march, const MarchGrid& grid) {
  double part = 0, whole = 0;
  for (int a = 0; a < plan.azimuths; ++a) {
    checkpoint();
    const double length_m = march.rangesOf(a) * plan.cells.range_step_m;
    const int steps = std::min(int(length_m / grid.range_step_m), int(march.ground_steps) - 1);
    part += steps * staircasePart(march.ground_msl_m.data() + std::size_t(a) * march.ground_steps, steps,
                                  grid.range_step_m, grid.maxSine(), grid.slope_part);
    whole += steps;
  }
  return whole > 0 ? part / whole : 0;
}

/// The grid with another largest angle.
MarchGrid withAngle(const MarchGrid& grid, double angle_deg) {
  MarchGrid other = grid;
  other.top_m =
      grid.intervals * kPeEvenBand * wavelength_m(grid.frequency_hz) / (2 * std::sin(degToRad(angle_deg)));
  return other;
}

}  // namespace

unsigned partWarning(double part, int shift) {
  return unsigned(std::lround(1000 * std::clamp(part, 0.0, 1.0))) << shift;
}

unsigned staircaseWarning(const MarchGrid& grid,
                          const std::function<double(const MarchGrid& grid)>& staircase_part) {
  constexpr double kNear = 0.005;      // of the steps
  constexpr double kWorthwhile = 0.5;  // of the staircases remain
  const double part = staircase_part(grid);
  if (!(part > 0)) return 0;
  const double angle_deg = radToDeg(std::asin(std::min(1.0, kPeEvenBand * grid.maxSine())));
  const double affordable = std::sin(degToRad(angle_deg)) * kPeMaxIntervals / grid.intervals;
  const double largest_deg =
      std::min(kPeAngle.max, std::floor(radToDeg(std::asin(std::min(1.0, affordable)))));
  unsigned angle = 0;
  if (largest_deg > angle_deg) {
    const double best = staircase_part(withAngle(grid, largest_deg));
    if (best <= kWorthwhile * part) {
      angle = unsigned(std::floor(angle_deg)) + 1;
      while (angle < unsigned(largest_deg) && staircase_part(withAngle(grid, angle)) > best + kNear) ++angle;
    }
  }
  return partWarning(part, kPeStaircaseShift) | angle << kPeHoldsShift;
}

unsigned staircaseWarning(const PePlan& plan, const AzimuthMarch& march) {
  return staircaseWarning(plan.grid,
                          [&](const MarchGrid& grid) { return staircasePartOf(plan, march, grid); });
}

std::vector<std::string> peWarningMessages(unsigned warnings) {
  std::vector<std::string> messages;
  if (warnings & kPePointwiseAir) {
    messages.emplace_back(
        "profiles of the air with different numbers of levels are interpolated at each height: halfway "
        "between two ducts there are two faint ones");
  }
  if (warnings & kPeDuctOverLand) {
    messages.emplace_back(
        "the evaporation duct is left out over land (above mean sea level, or a 'ground' that is not water)");
  }
  if (warnings & kPeProfileEnds) {
    messages.emplace_back(
        "the profile of the air ends below the antenna or the top of the field: above it the air is "
        "standard");
  }
  if (warnings & kPeNearObstacle) {
    messages.emplace_back(
        "ground rises above the ray within two range steps of an end, where the march hardly resolves it: "
        "the "
        "loss may be wrong by 20 dB and more, and differ as much with the ends exchanged; compare with "
        "'diffraction'");
  }
  const double behind_percent = percentOf(warnings, kPeBehindShift);
  if (behind_percent >= 10) {
    messages.push_back(fmt::format(
        "ground above the equation's largest angle ends {:.0f} % of its marches' length; behind it "
        "'diffraction' applies; a larger 'max_angle_deg' reaches further",
        behind_percent));
  }
  const double staircase_percent = percentOf(warnings, kPeStaircaseShift);
  const unsigned holds_deg = warnings >> kPeHoldsShift & ((1u << kPeHoldsBits) - 1);
  if (staircase_percent > 0) {
    messages.push_back(fmt::format(
        "{:.1f} % of the ground is steeper or more sharply bent than the band of the equation holds, and "
        "taken as steps of a staircase; with another largest angle the field differs by some dB in sight and "
        "by 10 to 30 dB deep in shadow; {}",
        staircase_percent,
        holds_deg > 0 ? fmt::format("'max_angle_deg: {}' holds most of it", holds_deg)
                      : "no larger 'max_angle_deg' that the height steps afford holds most of it"));
  }
  return messages;
}

}  // namespace emscape::propagation
