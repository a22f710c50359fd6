/// Warnings of several computations of one study.
#pragma once

#include <string>
#include <vector>

namespace emscape::study {

/// A warning of FieldSolver without " (N times)": how often depends on what was computed before.
std::string withoutCount(const std::string& warning);

/// Adds the warnings that are not there yet, without their counts.
void addOnce(std::vector<std::string>& all, const std::vector<std::string>& more);

}  // namespace emscape::study
