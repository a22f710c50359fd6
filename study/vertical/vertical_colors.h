/// Colours of the values of a vertical diagram.
#pragma once

#include "emscape/render/transfer/transfer_function.h"
#include "emscape/study/vertical/vertical.h"
#include "render/annotate/canvas.h"

namespace emscape::study {

/// A scale of shades: for probabilities from 0 to 1, for other quantities down to 80 dB below the strongest
/// values.
class VerticalColors {
 public:
  explicit VerticalColors(const VerticalDiagram& diagram);

  const render::TransferFunction& function() const { return function_; }
  /// True if values are beyond an end of the scale.
  bool hasLower() const { return has_lower_; }
  bool hasHigher() const { return has_higher_; }
  /// The shade of a value; -1: blank, without a field.
  int shadeOf(float value) const;
  render::Ink inkOf(int shade) const;

 private:
  bool hasField(float value) const { return static_cast<double>(value) > (is_part_ ? 0.005 : floor_); }

  bool is_part_;  ///< a probability
  double floor_;
  double low_ = 0, high_ = 1;
  bool has_lower_ = false, has_higher_ = false;
  render::TransferFunction function_;
};

}  // namespace emscape::study
