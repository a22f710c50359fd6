/// A number that is dragged along a scale, without Dear ImGui: scale, steps, positions.
#pragma once

#include <optional>

#include "scenario/file/parameters.h"

namespace emscape::view {

/// The range over which a number is dragged, in the parameter's unit; other values are typed.
struct ValueSlider {
  enum class Scale {
    linear,
    logarithmic,  ///< of a positive minimum
    from_zero     ///< linear below the knee, logarithmic above it
  };
  double min = 0, max = 1;
  Scale scale = Scale::linear;
  double knee = 1;
  bool is_integer = false;

  /// 0 at the minimum, 1 at the maximum; outside of the range below 0 or above 1.
  double positionOf(double value) const;
  double valueAt(double position) const;
  /// The distance between values that are told apart at a value: 1, 2 or 5 times a power of ten.
  /// @param position_step  the distance of two positions, such as that of two pixels
  double stepAt(double value, double position_step) const;
  /// The part of the scale's length that a drag over its length moves the value by: 1, or less if a pixel
  /// would change the value by more than 2 %.
  double dragRate(double length_px) const;
  /// The multiple of the step that is nearest to the value at a position, within the range.
  double steppedValueAt(double position, double position_step) const;
};

/// The slider of a parameter; none: its values are only typed. The range contains `value`.
std::optional<ValueSlider> sliderOf(const scenario::Parameter& parameter, double value);

}  // namespace emscape::view
