/// A volume as a grid of OpenVDB: the only header that names OpenVDB.
#pragma once

#include <openvdb/openvdb.h>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume::vdb {

/// Initialises OpenVDB; may be called repeatedly.
void initializeOpenVdb();

/// A FloatGrid, or an Int32Grid for a categorical volume, with metadata as in volume/format/vdb.h.
/// @throws Error (bad_input) at `location` for categorical values that are not indices
openvdb::GridBase::Ptr toOpenVdb(const DenseVolume& volume, const SourceLocation& location);

}  // namespace emscape::volume::vdb
