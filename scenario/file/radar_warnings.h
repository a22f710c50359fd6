#pragma once

#include "scenario/file/parse_sections.h"

namespace emscape::scenario {

/// Those of addScenarioWarnings() about receivers and waveforms of radars.
void addRadarWarnings(const Scenario& scenario, const Section& root, ParseContext& context);

}  // namespace emscape::scenario
