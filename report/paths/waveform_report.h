/// A radar's waveform and detection losses for `emscape info` and `emscape profile`.
#pragma once

#include "emscape/scenario/model/scenario.h"
#include "report/json.h"
#include "report/text.h"

namespace emscape::report {

/// The waveform's figures; null without one. The keys are documented in docs/command-line.md.
Json waveformJson(const scenario::Scenario& scenario, const scenario::Emitter& emitter);

/// Adds the figures as lines of a table; nothing without a waveform.
void addWaveform(Text& out, const scenario::Scenario& scenario, const scenario::Emitter& emitter);

}  // namespace emscape::report
