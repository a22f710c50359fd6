#pragma once

#include "scenario/file/parse_sections.h"

namespace emscape::scenario {

/// Whether a jammer's signal is within a radar's band.
bool isInBandOf(const Emitter& radar, const Emitter& jammer);

/// Those of addScenarioWarnings() about receivers and waveforms of radars.
void addRadarWarnings(const Scenario& scenario, const Section& root, ParseContext& context);

}  // namespace emscape::scenario
