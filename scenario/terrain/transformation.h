/// Transformations between coordinate systems that files name. Also used by the readers of maps and vectors.
#pragma once

#include "base/geodesy/gdal.h"

namespace emscape::scenario {

/// Null if there is none; GDAL's last error says why.
gdal::Transformation newTransformation(OGRSpatialReferenceH from, OGRSpatialReferenceH to);

}  // namespace emscape::scenario
