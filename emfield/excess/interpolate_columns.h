/// The excess of columns that are not computed, from those around them.
#pragma once

#include <cmath>

#include "emfield/excess/fill_excess.h"

namespace emscape::emfield {

/// The lines of a ColumnPart between which a column lies in one direction.
struct LinesAround {
  int below, after;  ///< indices of columns; equal if there is one line only
  float weight;      ///< of `after`, 0..1
  bool is_line;      ///< the column is on a line itself

  EMSCAPE_HD LinesAround(int i, int count, int step) {
    const int last = count - 1;
    const int before_last = last > 0 ? (last - 1) / step * step : 0;
    below = i / step * step < before_last ? i / step * step : before_last;
    after = below + step < last ? below + step : last;
    weight = after == below ? 0 : static_cast<float>(i - below) / static_cast<float>(after - below);
    is_line = i % step == 0 || i == last;
  }
};

/// Linear between two values; the nearer one if a value is unknown or infinite.
EMSCAPE_HD __attribute__((always_inline)) inline float between(float a, float b, float weight) {
  const float mixed = a + weight * (b - a);
  const float nearer = weight < 0.5f ? a : b;
  return std::fabs(mixed) < HUGE_VALF ? mixed : nearer;  // false for NaN
}

/// The code of a value between codes, which is unknown if it is NaN.
EMSCAPE_HD __attribute__((always_inline)) inline ExcessCode codeBetween(float value) {
  const float rounded = value + (value < 0 ? -0.5f : 0.5f);
  return value == value ? static_cast<ExcessCode>(static_cast<int>(rounded)) : kUnknownExcess;
}

/// A column of the part, between which others are interpolated.
class PartColumn {
 public:
  /// @param codes  of the grid
  EMSCAPE_HD PartColumn(const ExcessGrid& grid, const ExcessCode* codes, std::size_t column)
      : codes_(grid.isLeftOut(column) ? nullptr : codes + column),
        in_layer_(grid.column_count),
        lowest_(grid.firstValid(column) < grid.layers ? grid.firstValid(column) : grid.layers - 1) {}
  /// Its code in a layer, as a number; below its ground that of its lowest layer above it. NaN: unknown or
  /// left out.
  EMSCAPE_HD float operator()(int layer) const {
    if (codes_ == nullptr) return NAN;
    const ExcessCode code = codes_[static_cast<std::size_t>(layer > lowest_ ? layer : lowest_) * in_layer_];
    return code == kUnknownExcess ? NAN : static_cast<float>(code);
  }

 private:
  const ExcessCode* codes_;
  std::size_t in_layer_;
  int lowest_;
};

/// Fills the columns of a grid that ExcessGrid::part does not contain: excess in decibels and shadow edges,
/// bilinear between the columns of the part. A column of the part has in layers below its ground the excess
/// of its lowest layer above it. Where one of two columns is unknown, and at edges without limit, the value
/// is that of the nearer one.
/// @param out  with codes, and without reflected rays and mechanisms, which are not interpolated
void interpolateColumnsCpu(const ExcessGrid& grid, const ExcessOutput& out);

}  // namespace emscape::emfield
