// The only unit that converts OpenVDB grids to NanoVDB: it takes long to compile.
#include <nanovdb/util/OpenToNanoVDB.h>

#include "volume/format/vdb_functions.h"
#include "volume/vdb/grid.h"

namespace emscape::volume::vdb {

nano::Handle toNano(const DenseVolume& volume, const SourceLocation& location) {
  const openvdb::GridBase::Ptr grid = toOpenVdb(volume, location);
  if (volume.info.categorical) {
    return nanovdb::OpenToNanoVDB<std::int32_t, std::int32_t>()(
        *openvdb::gridPtrCast<openvdb::Int32Grid>(grid));
  }
  return nanovdb::OpenToNanoVDB<float, float>()(*openvdb::gridPtrCast<openvdb::FloatGrid>(grid));
}

}  // namespace emscape::volume::vdb
