/// Model `p528` at many points of one emitter: over a smooth earth its loss depends on range and height only,
/// which are tabulated where the points are, as finely as the accuracy takes.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "propagation/inputs.h"
#include "propagation/p528/p528.h"

namespace emscape::propagation {

/// A table that grows with the points that are asked for: cells of range and height with a biquadratic
/// polynomial. A cell is checked at four further points, and divided in four where it differs from the model.
/// The few points of cells that are still open, at steps of the model, are computed by the model itself.
class P528PointTable {
 public:
  struct Point {
    double range_m;   ///< along the ground; NaN: left out
    double height_m;  ///< above the smooth earth, within kP528Height
  };

  /// @param tx_m        height of the emitter (m), within kP528Height
  /// @param lowest_m    lowest height of all points, and highest
  /// @param farthest_m  largest range of all points
  P528PointTable(const EmitterInputs& emitter, double tx_m, double lowest_m, double highest_m,
                 double farthest_m);
  P528PointTable(const P528PointTable&) = delete;
  P528PointTable& operator=(const P528PointTable&) = delete;
  ~P528PointTable();

  /// Sets the excess (dB) of points; that of a point that is left out stays. Later calls use the cells of
  /// earlier ones. Results do not depend on the number of threads.
  /// @param pointOf    of an index below count
  /// @param excess_db  `count` values
  /// @accuracy 99.9 % within 0.01 dB of P528Curve; all within 0.03 dB, beside steps of the model, whose
  /// absorption of level rays has some of this size
  void fill(std::size_t count, const std::function<Point(std::size_t)>& pointOf, float* excess_db);

  /// Number of evaluations of the model so far.
  std::size_t evaluations() const;

 private:
  class Row;
  struct Place;

  P528Curve curveOf(double height_m) const;
  float excessAt(const P528Curve& curve, double range_m) const;
  /// The model itself.
  float modelAt(const Point& point) const;
  double horizonOf_m(double root) const;
  double steepOf_m(double height_m) const;

  std::shared_ptr<const P528Atmosphere> atmosphere_;
  double frequency_hz_;
  bool vertical_;
  double time_percent_;
  P528Terminal tx_;
  double lowest_root_, span_root_;  ///< square roots of heights
  double farthest_ratio_;
  std::vector<double> horizons_m_;  ///< at equidistant roots
  std::vector<Row> rows_;           ///< of cells, by height
};

}  // namespace emscape::propagation
