/// Colours of the sides of a battlefield.
#pragma once

#include "emscape/render/annotate/overlay.h"
#include "emscape/render/transfer/transfer_function.h"

namespace emscape::render {

/// Light colour of a side, as of its frame.
Rgb colorOf(Affiliation side);

}  // namespace emscape::render
