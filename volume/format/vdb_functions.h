/// What the library emscape_vdb (volume/vdb) does, the only one that is linked with OpenVDB: it is loaded
/// when a volume is first read, written or converted by OpenVDB. Internal to the module.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "emscape/base/log.h"
#include "emscape/volume/dense_volume.h"
#include "volume/sparse/nanovdb_wrapper.h"

namespace emscape::volume {

struct VdbFunctions {
  DenseVolume (*read)(const std::filesystem::path&, const std::string& grid_name);  ///< readVdb()
  std::vector<DenseVolume> (*describe)(const std::filesystem::path&);               ///< describeVdb()
  void (*write)(const std::filesystem::path&,
                const std::vector<const DenseVolume*>& volumes);      ///< writeVdb()
  nano::Handle (*toNano)(const DenseVolume&, const SourceLocation&);  ///< toNano()
};

/// The only function that the library exports: EMSCAPE_VDB_ENTRY, which has the version in its name.
/// @param log  receives the library's messages: it has its own copy of base
using VdbEntry = void(VdbFunctions& functions, const LogSink& log);

namespace vdb {
DenseVolume read(const std::filesystem::path& path, const std::string& grid_name);
std::vector<DenseVolume> describe(const std::filesystem::path& path);
void write(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes);
nano::Handle toNano(const DenseVolume& volume, const SourceLocation& location);
}  // namespace vdb

}  // namespace emscape::volume
