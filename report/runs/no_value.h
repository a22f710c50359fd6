/// Fields without any value, and their likely cause.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"

namespace emscape::report {

/// The warning about a field of which no voxel is above the floor.
/// @param times_s  of the field
std::string noValueWarning(const std::string& quantity, const scenario::Scenario& scenario,
                           const std::vector<double>& times_s);

}  // namespace emscape::report
