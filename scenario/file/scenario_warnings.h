#pragma once

#include "scenario/file/parse_sections.h"

namespace emscape::scenario {

/// Adds the warnings about what a faultless scenario says but hardly means: one problem per kind, at the
/// first of the emitters, receivers or targets that it concerns.
/// @param root  of a scenario without faults
void addScenarioWarnings(const Scenario& scenario, const Section& root, ParseContext& context);

}  // namespace emscape::scenario
