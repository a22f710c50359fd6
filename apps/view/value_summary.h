/// Histogram of a volume, for the editor of colours and opacities.
#pragma once

#include "emscape/render/transfer_function.h"
#include "emscape/volume/statistics.h"
#include "emscape/volume/volume.h"

namespace emscape::view {

struct ValueSummary {
  volume::Volume volume;            ///< that was counted
  volume::Histogram histogram;      ///< over info().range_*; no counts if that has no width
  render::TransferFunction fitted;  ///< the default function for it
};

/// Takes as long as reading every voxel, on one thread. @throws Error (device)
ValueSummary summaryOf(const volume::Volume& volume);

/// True if the values are the same object.
bool sameValues(const volume::Volume& a, const volume::Volume& b);

}  // namespace emscape::view
