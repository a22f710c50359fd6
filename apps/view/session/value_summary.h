/// Histogram of a field, for the editor of colours and opacities.
#pragma once

#include "emscape/playback/shown_field.h"
#include "emscape/render/transfer_function.h"
#include "emscape/volume/statistics.h"

namespace emscape::view {

struct ValueSummary {
  playback::ShownField field;       ///< that was counted
  volume::Histogram histogram;      ///< over info().range_*; no counts if that has no width
  render::TransferFunction fitted;  ///< the default function for it
};

/// Takes as long as reading every value, on one thread. @throws Error (device)
ValueSummary summaryOf(const playback::ShownField& field);

}  // namespace emscape::view
