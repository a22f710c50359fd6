/// Warnings of several computations of one study.
#pragma once

#include <string>
#include <vector>

namespace emscape::study {

/// A warning of FieldSolver without " (N times)", because the count depends on previous computations.
std::string withoutCount(const std::string& warning);

/// Adds new warnings, without their counts.
void addOnce(std::vector<std::string>& all, const std::vector<std::string>& more);

}  // namespace emscape::study
