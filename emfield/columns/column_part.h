/// The columns of a grid that are computed, while others are interpolated between them or already known.
#pragma once

#include <cstddef>

#include "emscape/base/host_device.h"
#include "emscape/volume/grid.h"

namespace emscape::emfield {

struct ColumnPart {
  int step = 1;   ///< every step-th column in each direction and the last ones
  int known = 0;  ///< without those of this step; 0: none

  EMSCAPE_HD bool isAll() const { return step == 1 && known == 0; }
  EMSCAPE_HD bool contains(const Dims& dims, std::size_t column) const {
    if (isAll()) return true;
    const auto row = static_cast<std::size_t>(dims.x);
    const int x = static_cast<int>(column % row), y = static_cast<int>(column / row);
    return isOn(step, dims, x, y) && !(known > 0 && isOn(known, dims, x, y));
  }
  /// Number of columns as a fraction of all.
  double fraction(const Dims& dims) const {
    const double all = static_cast<double>(dims.x) * dims.y;
    return (countOf(step, dims) - (known > 0 ? countOf(known, dims) : 0)) / all;
  }

 private:
  EMSCAPE_HD static bool isOn(int step, const Dims& dims, int x, int y) {
    return (x % step == 0 || x == dims.x - 1) && (y % step == 0 || y == dims.y - 1);
  }
  static double countOf(int step, const Dims& dims) {
    const auto of = [step](int count) { return (count - 1 + step - 1) / step + 1; };
    return static_cast<double>(of(dims.x)) * of(dims.y);
  }
};

}  // namespace emscape::emfield
