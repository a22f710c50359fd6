/// A volume as a grid of OpenVDB. Internal to the module: the only header that names OpenVDB.
#pragma once

#include <openvdb/openvdb.h>

#include "emscape/volume/dense_volume.h"

namespace emscape::volume {

/// Makes OpenVDB ready; may be called often.
void initializeOpenVdb();

/// A FloatGrid, or an Int32Grid for a categorical volume, with metadata as in vdb.h.
/// @throws Error (bad_input) at `place` for categorical values that are no indices
openvdb::GridBase::Ptr toOpenVdb(const DenseVolume& volume, const SourceLocation& place);

}  // namespace emscape::volume
