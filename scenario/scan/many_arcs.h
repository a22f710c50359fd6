/// The power of an interval with so many arcs that going through them at each azimuth takes too long: one
/// elevation of the pattern, all azimuths at once. A row has one entry per azimuth of a circle and is
/// interpolated linearly between them.
#pragma once

#include <vector>

#include "scenario/scan/scan_sweep.h"

namespace emscape::scenario {

/// A run of azimuths, counted in entries of a row.
struct RowSpan {
  double begin = 0, end = 0;
};

/// For means: the weights with which the entries of a pattern's row enter the power of the interval. Exact
/// for the interpolated row.
/// @param arcs  of one elevation
std::vector<double> rowWeightsOf(const std::vector<SweptArc>& arcs, int azimuths);

/// For largest values: the disjoint runs of azimuths that the arcs pass. Gaps below half an entry are closed.
std::vector<RowSpan> rowSpansOf(const std::vector<SweptArc>& arcs, int azimuths);

/// Adds to each entry of a row the mean power there.
/// @param power    of the pattern, by azimuth relative to the beam
/// @param weights  as many
void addMean(const std::vector<double>& power, const std::vector<double>& weights, std::vector<double>& row);

/// Raises each entry of a row to the largest power there.
void raiseToLargest(const std::vector<double>& power, const std::vector<RowSpan>& spans,
                    std::vector<double>& row);

}  // namespace emscape::scenario
