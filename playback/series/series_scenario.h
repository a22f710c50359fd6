/// The scenario that a series on disk was computed from.
#pragma once

#include "emscape/playback/view/view_state.h"

namespace emscape::playback {

/// If a view's input is a series that Emscape wrote, its folder, list or one of its files, and the view has
/// no scenario: sets the scenario and the edits from which the series was computed, so that pictures have its
/// ground and emitters. Unchanged, with a warning, if the scenario or a file that it names is not there any
/// more or has another content.
void addOwnScenario(ViewState& view);

}  // namespace emscape::playback
