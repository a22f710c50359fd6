/// Edits in the words of the window.
#pragma once

#include <string>

#include "emscape/scenario/model/edit.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::view {

/// "ridge site, latitude: 36.27 → 36.32 °"; the value before only if the scenario does not have the edit. As
/// for --set if it is not the edit of one value.
std::string editText(const scenario::Scenario& scenario, const scenario::Edit& edit);

}  // namespace emscape::view
