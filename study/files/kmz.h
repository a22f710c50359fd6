/// Maps as KMZ: overlays on the globe over time, with legends, emitters and tracks.
#pragma once

#include "study/files/map_collection.h"

namespace emscape::study {

/// The maps are resampled to longitudes and latitudes with the nearest pixel. A map of a time is shown until
/// the next; the first product at its first height is switched on.
/// @throws Error (other) naming the file
std::unique_ptr<MapCollection> makeKmz(const std::filesystem::path& file, const MapStudy& study);

}  // namespace emscape::study
