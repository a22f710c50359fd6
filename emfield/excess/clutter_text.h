/// Trees and buildings in an emitter's losses: what is included, in words and as warnings.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/scenario.h"

namespace emscape::emfield {

/// True for models that read clutter heights along their paths: raised profiles, or their own clutter.
bool usesClutterMap(const propagation::ModelSettings& settings);

/// True if paths have clutter heights: of a map, or one height along all of the path.
/// @param terrain  null: none
bool hasClutter(const propagation::ModelSettings& settings, const scenario::Terrain* terrain);

/// For the line "ground cover: ..." of reports; "none" without any.
std::string clutterText(const scenario::Scenario& scenario, const scenario::Emitter& emitter);
/// The same for all emitters of a scenario, by name where they differ, and the radars that receive echoes of
/// clutter, which is something else.
std::string clutterText(const scenario::Scenario& scenario);

/// Warnings of keys of clutter that have no effect on an emitter, and of models that ignore the terrain.
std::vector<std::string> clutterWarnings(const scenario::Scenario& scenario,
                                         const scenario::Emitter& emitter);

}  // namespace emscape::emfield
