/// Regular posts and parts of them.
#pragma once

namespace emscape::scenario {

/// Regular posts in a plane: longitude and latitude (deg), or a projection's own coordinates. Post (0, 0) is
/// the south-western one; columns count eastwards, rows northwards.
struct PostLattice {
  double x0 = 0, y0 = 0;
  double step_x = 1, step_y = 1;  ///< > 0

  double x(double column) const { return x0 + column * step_x; }
  double y(double row) const { return y0 + row * step_y; }
  double column(double x) const { return (x - x0) / step_x; }
  double row(double y) const { return (y - y0) / step_y; }
};

/// A rectangle of posts of a lattice.
struct PostWindow {
  long long first_column = 0, first_row = 0;
  long long columns = 0, rows = 0;

  bool empty() const { return columns <= 0 || rows <= 0; }
};

/// A rectangle of the plane.
struct PlaneBox {
  double x_min = 0, y_min = 0, x_max = 0, y_max = 0;
};

}  // namespace emscape::scenario
