/// The budget of a path as text, for `emscape profile` and the window's probe.
#pragma once

#include <string>
#include <vector>

#include "emscape/emfield/link/path_budget.h"

namespace emscape::emfield {

/// One line: a name and its text.
struct ReportLine {
  std::string name;
  std::string text;
};

/// Adds to a path's warnings that of ground too steep for its march, of several plans
/// (steepGroundWarnings()): for one path that is shown.
void tellSteepGround(PathBudget& budget);

/// The ends of the path and its geometry.
std::vector<ReportLine> geometryLines(const PathBudget& budget);

/// A term's value with two decimals; "no field" for -infinity, "infinite" for +infinity; 0.00 without a sign.
std::string valueText(double value);

/// The trees or buildings on an obstacle: "ground cover 20 m high ('Woods')".
std::string coverText(const PathObstacle& obstacle);

/// Remark on an obstacle: "earth's bulge" or what stands on it, and "decides".
std::string remarkOf(const PathObstacle& obstacle);

/// True if the ground, the earth's bulge, or trees or buildings that the model reads are above the ray.
bool isBlocked(const PathBudget& budget);

}  // namespace emscape::emfield
