/// Why a field of a scenario is empty.
#pragma once

#include <string>

#include "emscape/scenario/model/scenario.h"

namespace emscape::playback {

/// "no radar transmits", or "no radar is present", if a quantity has no value anywhere since nothing that it
/// is about transmits at the time of the field, or in the interval that begins then; empty if something does.
/// @param quantity  as volumes name it, "snr_db" or "snr_db:CHANNEL"
std::string silenceText(const scenario::Scenario& scenario, const std::string& quantity, double time_s);

}  // namespace emscape::playback
