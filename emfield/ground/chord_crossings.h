/// Where a chord crosses the lines between the posts of its raster, in closed form.
///
/// Between four posts the ground is bilinear: along a path it is smooth in a cell, and its crests are on the
/// lines between the posts. The posts of a path with such a profile are, in the order of their ranges:
/// - of each chord in the finest raster without a void on it, if they are not too many
///   (GroundPosts::maxCrossings): its beginning and its crossings; of other chords its beginning and the
///   regular posts on it,
/// - among the crossings of the first chord the first GroundPosts::near_count regular posts: near the emitter
///   a hump between the lines masks a large angle.
/// The posts are farther than the emitter and nearer than the receivers: see crossingRange_m().
#pragma once

#include <cmath>

#include "emfield/ground/terrain_walk.h"
#include "emscape/base/host_device.h"
#include "propagation/terrain_profile.h"

namespace emscape::emfield {

/// The crossings of a chord with the columns or the rows of its raster, in the order of increasing part. A
/// chord that is nearly parallel to the lines may turn back once.
struct LineCrossings {
  Parabola<float> coordinate;  ///< whose integers are the lines
  float to_root = 1;           ///< 1 where the coordinate rises at first, else -1
  float turn = 2;              ///< part at which the chord turns; beyond 1: it does not
  int first_cell = 0, last_cell = 0, turn_cell = 0;
  int step = 1;         ///< from one line to the next before the turn
  int before_turn = 0;  ///< crossings before the turn
  int count = 0;
  bool is_straight = false;  ///< nearly, and without a turn: see partOfStraight()

  explicit EMSCAPE_HD LineCrossings(const Parabola<float>& of) : coordinate(of) {
    const float* const c = of.c;
    const float slope_at_end = c[1] + 2 * c[2];
    to_root = c[1] > 0 || (c[1] == 0 && c[2] > 0) ? 1.0f : -1.0f;
    step = to_root > 0 ? 1 : -1;
    if (c[1] * slope_at_end < 0) turn = -c[1] / (2 * c[2]);
    first_cell = cellOf(0);
    last_cell = cellOf(1);
    turn_cell = turn < 1 ? cellOf(turn) : last_cell;
    before_turn = distance(first_cell, turn_cell);
    count = before_turn + distance(turn_cell, last_cell);
    is_straight = std::fabs(c[2]) < 0.007f * std::fabs(c[1]);
  }

  /// The line of crossing n, 0 <= n < count.
  template <bool kStraight = false>
  EMSCAPE_HD int line(int n) const {
    if (kStraight) return (step > 0 ? first_cell + 1 : first_cell) + step * n;
    const int first = first_cell + (step > 0 ? 1 : 0), after = turn_cell + (step > 0 ? 0 : 1);
    return n < before_turn ? first + step * n : after - step * (n - before_turn);
  }
  /// The part of the chord at which crossing n is: 0..1.
  template <bool kStraight = false>
  EMSCAPE_HD float part(int n, int line) const {
    if (kStraight) return partOfStraight(line);
    const float* const c = coordinate.c;
    const float to_line = static_cast<float>(line) - c[0], square = c[1] * c[1] + 4 * c[2] * to_line;
    const float sum = c[1] + to_root * std::sqrt(square > 0 ? square : 0.0f);
    const float part = (n < before_turn ? 2 * to_line : -sum) / (n < before_turn ? sum : 2 * c[2]);
    return part > 0 ? (part < 1 ? part : 1.0f) : 0.0f;
  }
  /// The same where is_straight, without a division: a series of part(), within 5e-8.
  EMSCAPE_HD float partOfStraight(int line) const {
    const float* const c = coordinate.c;
    const float inverse = 1 / c[1], to = (static_cast<float>(line) - c[0]) * inverse;
    const float bend = 4 * c[2] * inverse * to;
    const float part = to * (1 - bend * (0.25f - bend * (0.125f - bend * 0.078125f)));
    return part > 0 ? (part < 1 ? part : 1.0f) : 0.0f;
  }
  /// Number of crossings before a part of the chord, at which the coordinate is in a cell: 0..count. That of
  /// the other lines' crossings gives their order.
  EMSCAPE_HD int countBefore(float part, int cell) const {
    const int before = part < turn ? distance(first_cell, cell) : count - distance(cell, last_cell);
    return before < count ? (before > 0 ? before : 0) : count;
  }

 private:
  EMSCAPE_HD int cellOf(float part) const { return static_cast<int>(coordinate.at(part)); }
  static EMSCAPE_HD int distance(int a, int b) { return a < b ? b - a : a - b; }
};

/// A post on a line.
struct Crossing {
  float part;          ///< of the chord
  float height_msl_m;  ///< between two posts of the raster; NaN beside a void
  /// Place in the order of the chord's posts, 1..ChordCrossings::count(); its beginning is 0. At a post of
  /// the raster, where a column and a row are crossed at once, both may have the same place, and the next or
  /// the last one stays empty.
  int place;
};

/// The crossings of a chord with all lines.
struct ChordCrossings {
  LineCrossings columns, rows;
  const float* corner_msl_m;
  int row_posts;

  /// @param chord  with a raster
  explicit EMSCAPE_HD ChordCrossings(const RasterChord& chord)
      : columns(chord.column),
        rows(chord.row),
        corner_msl_m(chord.corner_msl_m),
        row_posts(chord.row_posts) {}

  EMSCAPE_HD int count() const { return columns.count + rows.count; }

  /// Crossing n with a column, 0 <= n < columns.count.
  /// @tparam kStraight  true: faster; only where columns.is_straight
  template <bool kStraight = false>
  EMSCAPE_HD Crossing atColumn(int n) const {
    const int i = columns.line<kStraight>(n);
    const float part = columns.part<kStraight>(n, i), y = rows.coordinate.at(part);
    const int j = static_cast<int>(y), at = j * row_posts + i;
    const float south = corner_msl_m[at], north = corner_msl_m[at + row_posts];
    return {part, lerp(south, north, y - static_cast<float>(j)), 1 + n + rows.countBefore(part, j)};
  }
  /// Crossing n with a row, 0 <= n < rows.count.
  template <bool kStraight = false>
  EMSCAPE_HD Crossing atRow(int n) const {
    const int j = rows.line<kStraight>(n);
    const float part = rows.part<kStraight>(n, j), x = columns.coordinate.at(part);
    const int i = static_cast<int>(x);
    const int at = j * row_posts + i;
    const float west = corner_msl_m[at], east = corner_msl_m[at + 1];
    return {part, lerp(west, east, x - static_cast<float>(i)), 1 + n + columns.countBefore(part, i)};
  }
};

/// Range (m) of a crossing, beyond the emitter and before the receivers, also as float.
EMSCAPE_HD inline double crossingRange_m(double chord_begin_m, double chord_m, float part,
                                         double receivers_m) {
  constexpr double kFirst_m = 0.01;
  const double range_m = chord_begin_m + chord_m * static_cast<double>(part);
  const double last_m = receivers_m * propagation::kBeforeReceivers;
  return range_m < last_m ? (range_m > kFirst_m ? range_m : kFirst_m) : last_m;
}

}  // namespace emscape::emfield
