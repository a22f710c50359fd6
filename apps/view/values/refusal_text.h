/// Why an edit was refused, in the words of the window.
#pragma once

#include <string>
#include <vector>

#include "emscape/scenario/model/edit.h"

namespace emscape::view {

/// The message of a scenario's check without places in files, and with the names of values instead of their
/// keys.
std::string refusalText(const std::string& error, const std::vector<scenario::Edit>& edits);

}  // namespace emscape::view
