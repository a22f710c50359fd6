/// Converts a scenario's clutter to the inputs of the loops over voxels.
#pragma once

#include <optional>

#include "emfield/clutter/clutter_beam.h"
#include "emfield/clutter/mti.h"
#include "emfield/combine/clutter_echo.h"
#include "emscape/scenario/model/scenario.h"
#include "emscape/scenario/model/snapshot.h"

namespace emscape::emfield {

/// The filter of a radar with clutter; empty if it has none.
std::optional<MtiFilter> mtiFilterOf(const scenario::Emitter& radar);

/// Ratio of the echo's power over noise after the radar's filter to that before it; 1 without a filter.
double filterResponse(const scenario::Emitter& radar);

/// Improvement of echo over clutter by the radar's filter: 1 without one.
double surfaceImprovement(const scenario::Emitter& radar);
double rainImprovement(const scenario::Emitter& radar);

/// Clutter of a radar after its filter, without the values that depend on its site.
ClutterTask clutterTask(const scenario::Scenario& scenario, const scenario::Emitter& radar);
/// The same with the values for its site.
ClutterTask placedAt(const scenario::EmitterState& state, const scenario::Scenario& scenario,
                     ClutterTask task);

}  // namespace emscape::emfield
