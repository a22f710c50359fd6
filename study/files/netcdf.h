/// Maps as netCDF according to CF-1.8.
#pragma once

#include "study/files/map_collection.h"

namespace emscape::study {

/// One variable for each product and reference of heights, such as covered_agl, over time, height, y and x,
/// as far as the product has these dimensions. Decibels have units of UDUNITS: "0.1 lg(re 1 W m-2)".
/// @throws Error (other) naming the file
std::unique_ptr<MapCollection> makeNetCdf(const std::filesystem::path& file, const MapStudy& study);

}  // namespace emscape::study
