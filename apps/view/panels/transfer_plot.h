/// The opacity curve over the histogram of the values, with its colours below, edited with the mouse.
#pragma once

#include "apps/view/panels/panels.h"

namespace emscape::view {

/// Draws the plot over the remaining width and handles the mouse. @pre the session has editable colours
void drawTransferPlot(PanelContext& context);

}  // namespace emscape::view
