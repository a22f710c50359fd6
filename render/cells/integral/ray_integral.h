/// Ray integral over segments with a linear value. Host and device.
#pragma once

#include <cmath>

#include "emscape/base/host_device.h"
#include "emscape/render/transfer/transfer_function.h"
#include "render/cast/rgba.h"
#include "render/cells/integral/psi.h"

namespace emscape::render {

/// Interval of values on which extinction and colour are linear.
struct TransferInterval {
  double lower, upper;   ///< of the value; infinite at the ends
  double extinction[2];  ///< per reference step, at lower and upper
  Rgb color[2];
  bool clear;    ///< no extinction
  bool uniform;  ///< extinction and colour are the same at both ends

  /// Fraction of the interval from lower to upper; the interval must not be uniform.
  EMSCAPE_HD double at(double value) const { return uniform ? 0 : (value - lower) / (upper - lower); }
};

/// Intervals, ascending; they cover all values.
struct IntervalsView {
  const TransferInterval* intervals = nullptr;
  int count = 0;

  /// Interval that contains a value; at a common end the upper one.
  EMSCAPE_HD int indexOf(double value) const {
    int low = 0, high = count;  // first interval that begins above the value
    while (low < high) {
      const int middle = (low + high) / 2;
      if (value < intervals[middle].lower) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    return low - 1;
  }
};

/// Colour and transmittance accumulated along a ray, from the front to the back.
class RayIntegral {
 public:
  EMSCAPE_HD RayIntegral(const IntervalsView& transfer, const PsiLookup& psi)
      : transfer_(transfer), psi_(psi) {}

  /// Adds a segment behind the earlier ones; the value is linear along it. The segment is split at the
  /// control points of the transfer function, so that no feature between the ends is lost.
  /// @param front, back  values at its ends @param length  in reference steps, >= 0
  EMSCAPE_HD void add(double front, double back, double length) {
    if (!(length > 0)) return;
    const TransferInterval* const intervals = transfer_.intervals;
    if (front != last_) interval_ = transfer_.indexOf(front);
    last_ = back;
    const bool rises = back > front;
    const double per_value = length / (back - front);  // not used where they are equal
    // At a control point the interval towards the back is used.
    while (rises && intervals[interval_].upper <= front) ++interval_;
    while (back < front && intervals[interval_].lower >= front) --interval_;
    for (double value = front;;) {
      const TransferInterval& interval = intervals[interval_];
      const bool ends_here = rises ? back <= interval.upper : back >= interval.lower;
      if (ends_here) {
        const double left = front == back ? length : (back - value) * per_value;
        addPiece(interval, value, back, left);
        return;
      }
      const double end = rises ? interval.upper : interval.lower;
      addPiece(interval, value, end, (end - value) * per_value);
      value = end;
      rises ? ++interval_ : --interval_;
    }
  }

  /// Transmittance, 0..1.
  EMSCAPE_HD double through() const { return through_; }
  EMSCAPE_HD Rgba color() const {
    return {static_cast<float>(red_), static_cast<float>(green_), static_cast<float>(blue_),
            static_cast<float>(1 - through_)};
  }

 private:
  EMSCAPE_HD void addPiece(const TransferInterval& interval, double front, double back, double length) {
    if (interval.clear || !(length > 0)) return;
    const double low = interval.extinction[0], high = interval.extinction[1];
    if (interval.uniform) {
      const double opacity = -expm1(-low * length) * through_;
      const Rgb& color = interval.color[0];
      red_ += opacity * static_cast<double>(color.r);
      green_ += opacity * static_cast<double>(color.g);
      blue_ += opacity * static_cast<double>(color.b);
      through_ -= opacity;
      return;
    }
    const double at_front = interval.at(front), at_back = interval.at(back);
    const double depth_front = (low + at_front * (high - low)) * length;
    const double depth_back = (low + at_back * (high - low)) * length;
    const double opacity = -expm1(-0.5 * (depth_front + depth_back));
    const double of_psi = psi_(depth_back, depth_front);
    const double weight_front = (1 - of_psi) * through_;
    const double weight_back = (of_psi - 1 + opacity) * through_;
    const Rgb &color_low = interval.color[0], &color_high = interval.color[1];
    const auto mix = [&](float of_low, float of_high) {
      const double from = static_cast<double>(of_low), rise = static_cast<double>(of_high) - from;
      return weight_front * (from + at_front * rise) + weight_back * (from + at_back * rise);
    };
    red_ += mix(color_low.r, color_high.r);
    green_ += mix(color_low.g, color_high.g);
    blue_ += mix(color_low.b, color_high.b);
    through_ *= 1 - opacity;
  }

  IntervalsView transfer_;
  PsiLookup psi_;
  double red_ = 0, green_ = 0, blue_ = 0, through_ = 1;
  double last_ = NAN;  ///< value at the back end of the last segment
  int interval_ = 0;   ///< interval that contains it
};

}  // namespace emscape::render
