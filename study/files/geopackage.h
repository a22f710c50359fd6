/// Maps as a GeoPackage: bands, contours, emitters and tracks, with styles for QGIS.
#pragma once

#include "study/files/map_collection.h"

namespace emscape::study {

/// Layers `bands` and `contours` in the grid's projection, `emitters` and `tracks` in WGS84, `layer_styles`.
/// The same maps give the same bytes: modification dates are the study's time 0.
/// @throws Error (other) naming the file
std::unique_ptr<MapCollection> makeGeoPackage(const std::filesystem::path& file, const MapStudy& study);

}  // namespace emscape::study
