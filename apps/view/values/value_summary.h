/// Histogram of a field, for the editor of colours and opacities.
#pragma once

#include "emscape/playback/frames/shown_field.h"
#include "emscape/render/transfer/transfer_function.h"
#include "emscape/volume/statistics.h"

namespace emscape::view {

struct ValueSummary {
  playback::ShownField field;       ///< the summarised field
  volume::Histogram histogram;      ///< over info().range_*; no counts if the range is empty
  render::TransferFunction fitted;  ///< default function for the field
};

/// Reads every value, on one thread. @throws Error (device)
ValueSummary summaryOf(const playback::ShownField& field);

}  // namespace emscape::view
