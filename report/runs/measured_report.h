/// Measured paths against the propagation models, as JSON and text.
#pragma once

#include <string>

#include "emfield/check/measured_paths.h"
#include "report/json.h"

namespace emscape::report {

struct MeasuredReport {
  std::string file, scenario;  ///< as they were named; no scenario: empty
  std::string clutter;         ///< see emfield::clutterText()
  emfield::MeasuredCheck check;
};

/// The keys are documented in docs/measurements.md.
Json toJson(const MeasuredReport& report);
std::string measuredText(const MeasuredReport& report);

}  // namespace emscape::report
