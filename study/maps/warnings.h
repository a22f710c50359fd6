/// Warnings of several computations of one study.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace emscape::study {

/// Adds warnings without FieldSolver's " (N times)": N depends on previous computations.
void addOnce(std::set<std::string>& all, const std::vector<std::string>& more);

}  // namespace emscape::study
