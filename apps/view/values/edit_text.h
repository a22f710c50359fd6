/// Edits in the words of the window.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/edit.h"
#include "emscape/scenario/model/scenario.h"

namespace emscape::view {

/// Edits as changes of a scenario, one text each: "ridge site, latitude: 36.27 → 36.32 °", "jammer: removed";
/// as for --set where they are not those of one value.
/// @param original  without the edits
std::vector<std::string> editTexts(const scenario::Scenario& original,
                                   const std::vector<scenario::Edit>& edits);

}  // namespace emscape::view
