/// The cause that decides that a point is not covered: one rule for paths, comparisons and maps.
#pragma once

#include <array>
#include <string>

#include "emscape/base/enum_names.h"
#include "emscape/scenario/model/quantities.h"

namespace emscape::emfield {

struct PathBudget;

/// In the order of the classes of the map `cause`.
enum class PathCause {
  covered,
  silent,    ///< the emitter does not radiate
  range,     ///< beyond the range in which the radar looks
  jamming,   ///< covered without the jammers
  clutter,   ///< echoes of land, sea and rain; trees and buildings on the path
  terrain,   ///< hills, the earth's bulge, and what the model computes for the ground
  pointing,  ///< the antenna's pattern
  noise      ///< too weak even on the beam's axis in free space: distance, power, cross section
};
constexpr auto namesOf(PathCause) {
  return std::array{"covered", "silent", "range", "jamming", "clutter", "terrain", "pointing", "noise"};
}

/// The cause for which a quantity does not reach a threshold at the end of a path. Of terrain, clutter and
/// pointing, each with the decibels that the signal would gain without it (an echo twice), the largest that
/// suffices alone decides, else the largest; noise, if all of them together do not suffice.
/// @param threshold  in the quantity's unit
PathCause causeOf(const PathBudget& budget, scenario::Quantity quantity, double threshold);

/// A sentence of a verdict: "Terrain decides: without it the echo is 63.0 dB stronger; 41.2 dB are missing.";
/// empty: a radar detects the target, a receiver intercepts the signal, or the budget has neither.
std::string decisionText(const PathBudget& budget);

}  // namespace emscape::emfield
