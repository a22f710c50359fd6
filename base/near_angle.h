/// Sine and cosine of many angles close to each other.
#pragma once

#include <cmath>

namespace emscape {

struct SineCosine {
  double sine, cosine;
};

/// Takes most of them from one angle's by the series of the difference. Results do not depend on the angles
/// that were asked before.
/// @accuracy 4e-16
class NearAngle {
 public:
  /// @param angle_rad  of any size
  SineCosine at(double angle_rad) {
    const double step = std::floor(angle_rad * kStepsPerRad + 0.5);
    if (step != step_) {
      step_ = step;
      from_ = {std::sin(step / kStepsPerRad), std::cos(step / kStepsPerRad)};
    }
    const double d = angle_rad - step / kStepsPerRad, q = d * d;
    const double sine = d * (1 - q * (1. / 6) * (1 - q * (1. / 20)));
    const double versine = 0.5 * q * (1 - q * (1. / 12) * (1 - q * (1. / 30)));
    return {from_.sine + (from_.cosine * sine - from_.sine * versine),
            from_.cosine - (from_.sine * sine + from_.cosine * versine)};
  }

 private:
  static constexpr double kStepsPerRad = 128;
  double step_ = HUGE_VAL;
  SineCosine from_{};
};

}  // namespace emscape
