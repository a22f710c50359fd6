/// Times at which something of a scenario is present. Internal to the module.
#pragma once

#include <vector>

#include "emscape/scenario/model/scenario.h"

namespace emscape::playback {

/// Whether the platform of an emitter is present; an emitter without a platform always is.
bool isPresentAt(const scenario::Scenario& scenario, const scenario::Emitter& emitter, double time_s);

/// The first of ascending times, at least one, at which an emitter is present; else at which any platform is;
/// else the first of them.
double firstPresentTime_s(const scenario::Scenario& scenario, const std::vector<double>& times_s);

}  // namespace emscape::playback
