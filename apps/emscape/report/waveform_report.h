/// A radar's waveform and detection losses for `emscape info` and `emscape profile`.
#pragma once

#include "apps/emscape/common/console.h"
#include "emscape/scenario/model/emitter.h"

namespace emscape::app {

/// The waveform's figures; null without one. The keys are documented in docs/command-line.md.
Json waveformJson(const scenario::Emitter& emitter);

/// The same as lines of a table; nothing without a waveform.
void printWaveform(const scenario::Emitter& emitter);

}  // namespace emscape::app
