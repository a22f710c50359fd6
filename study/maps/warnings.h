/// Warnings of several computations of one study.
#pragma once

#include <string>
#include <vector>

namespace emscape::study {

/// Adds warnings that are not there yet, without FieldSolver's " (N times)": N depends on previous
/// computations.
void addOnce(std::vector<std::string>& all, const std::vector<std::string>& more);

}  // namespace emscape::study
