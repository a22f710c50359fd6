/// Maps as GeoJSON (RFC 7946).
#pragma once

#include "study/files/map_collection.h"

namespace emscape::study {

/// One collection of features: the bands of all maps as polygons, emitters and sites as points, tracks as
/// lines, in longitudes and latitudes. Property `layer`: bands, emitters, sites, tracks. Polygons across the
/// antimeridian keep longitudes beyond 180 degrees.
/// @throws Error (other) naming the file
std::unique_ptr<MapCollection> makeGeoJson(const std::filesystem::path& file, const MapStudy& study);

}  // namespace emscape::study
