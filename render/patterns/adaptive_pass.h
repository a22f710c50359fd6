/// The passes of the pattern `adaptive` and their predictions: single source for host and device.
#pragma once

#include "emscape/base/host_device.h"
#include "emscape/render/picture/image.h"
#include "render/patterns/adaptive_predict.h"

namespace emscape::render {

/// Distance of the pixels that are cast first.
constexpr int kLatticeStep = 4;

/// The midpoints of one pass: the centres of cells, or the middles of their sides.
struct Pass {
  int reach;  ///< distance of the nearest known pixels, along either axis; a power of two
  bool diagonal;
  double tolerance;  ///< fraction of the frame's tolerance

  EMSCAPE_HD int firstY() const { return diagonal ? reach : 0; }
  EMSCAPE_HD int stepY() const { return diagonal ? 2 * reach : reach; }
  EMSCAPE_HD int stepX() const { return 2 * reach; }
  EMSCAPE_HD int firstX(int y) const { return diagonal || (y & reach) == 0 ? reach : 0; }
  /// Number of midpoints along a row and a column of a picture, or one more.
  EMSCAPE_HD int columns(ImageSize size) const { return (size.width + stepX() - 1) / stepX(); }
  EMSCAPE_HD int rows(ImageSize size) const { return (size.height + stepY() - 1) / stepY(); }
};
constexpr Pass kPasses[] = {{2, true, 0.2}, {2, false, 0.5}, {1, true, 0.5}, {1, false, 1.0}};

/// Access to the picture: Known has Color, at(x, y) and `size`.
template <class Known>
EMSCAPE_HD bool contains(const Known& known, int x, int y) {
  return x >= 0 && y >= 0 && x < known.size.width && y < known.size.height;
}

/// Prediction along the direction (dx, dy) from a midpoint whose two nearest pixels are in the picture.
/// Pixels beyond its edge are extrapolated with the curvature on the other side.
template <class Known>
EMSCAPE_HD Along<typename Known::Color> alongFrom(const Known& known, int x, int y, int dx, int dy) {
  using Color = typename Known::Color;
  const bool has_low = contains(known, x - 3 * dx, y - 3 * dy);
  const bool has_high = contains(known, x + 3 * dx, y + 3 * dy);
  const Color a = known.at(x - dx, y - dy);
  const Color b = known.at(x + dx, y + dy);
  if (!has_low && !has_high) return predictAlong(a, b);
  const auto beyond = [&](int steps) { return known.at(x + steps * dx, y + steps * dy); };
  const Color low = has_low ? beyond(-3) : beyond(3) + (a - b) * 3;
  const Color high = has_high ? beyond(3) : low + (b - a) * 3;
  return predictAlong(a, b, low, high);
}

/// Predicts any midpoint of a pass. @return false: no direction has pixels at both ends
template <class Known>
EMSCAPE_HD bool predictMidpoint(const Known& known, const Pass& pass, int x, int y,
                                Prediction<typename Known::Color>& prediction) {
  const int r = pass.reach;
  const int dy_p = pass.diagonal ? r : 0;
  const int dx_q = pass.diagonal ? -r : 0;
  const bool has_p = contains(known, x - r, y - dy_p) && contains(known, x + r, y + dy_p);
  const bool has_q = contains(known, x - dx_q, y - r) && contains(known, x + dx_q, y + r);
  if (has_p && has_q) {
    prediction = predict(alongFrom(known, x, y, r, dy_p), alongFrom(known, x, y, dx_q, r));
  } else if (has_p) {
    prediction = predict(alongFrom(known, x, y, r, dy_p));
  } else if (has_q) {
    prediction = predict(alongFrom(known, x, y, dx_q, r));
  }
  return has_p || has_q;
}

}  // namespace emscape::render
