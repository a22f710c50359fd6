/// The opacity curve over the histogram of the values, with its colours below, edited by the mouse.
#pragma once

#include "apps/view/panels.h"

namespace emscape::view {

/// Draws it over the width that is left and lets the mouse edit. The session has colours to edit.
void drawTransferPlot(PanelContext& context);

}  // namespace emscape::view
