/// Transformations between coordinate systems that files name. Also used by the readers of maps and vectors.
#pragma once

#include "base/geodesy/gdal.h"

namespace emscape::scenario {

/// Null if there is none; GDAL's last error says why.
gdal::Transformation newTransformation(OGRSpatialReferenceH from, OGRSpatialReferenceH to);

/// WGS84: longitude, latitude. @throws Error (other) with PROJ's reason, as where its database is missing
gdal::SpatialReference wgs84Reference();
/// @throws Error (other) with PROJ's reason if there is no transformation
gdal::Transformation transformationBetween(const gdal::SpatialReference& from,
                                           const gdal::SpatialReference& to);

}  // namespace emscape::scenario
