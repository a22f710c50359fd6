/// The budget of a path in words: what `emscape profile` prints and the window's probe shows.
#pragma once

#include <string>
#include <vector>

#include "emscape/emfield/path_budget.h"

namespace emscape::emfield {

/// One line: a name and what is to be said of it.
struct ReportLine {
  std::string name;
  std::string text;
};

/// Where the ends are and how the path lies between them.
std::vector<ReportLine> geometryLines(const PathBudget& budget);

/// A term's value with two decimals: "none" and "all" for infinities, without a sign what rounds to nothing.
std::string valueText(double value);

/// What an obstacle is besides its figures: "earth's bulge", "decides", both or nothing.
std::string remarkOf(const PathObstacle& obstacle);

/// Whether ground or the earth's bulge stands above the ray.
bool isBlocked(const PathBudget& budget);

}  // namespace emscape::emfield
