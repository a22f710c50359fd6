/// What the library emscape_vdb (volume/vdb) does, the only one that is linked with OpenVDB: it is loaded
/// when a volume is first read, written or converted by OpenVDB. Internal to the module.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "emscape/base/log.h"
#include "emscape/base/work.h"
#include "emscape/volume/dense_volume.h"
#include "volume/sparse/nanovdb_wrapper.h"

namespace emscape::volume {

/// Each does a part of `work`, which may be null: the library has its own copy of base, which does not know
/// the work of the calling thread.
struct VdbFunctions {
  /// readVdb()
  DenseVolume (*read)(Work* work, const std::filesystem::path&, const std::string& grid_name);
  /// describeVdb()
  std::vector<DenseVolume> (*describe)(Work* work, const std::filesystem::path&);
  /// writeVdb()
  void (*write)(Work* work, const std::filesystem::path&, const std::vector<const DenseVolume*>& volumes);
  /// toNano()
  nano::Handle (*toNano)(Work* work, const DenseVolume&, const SourceLocation&);
};

/// The only function that the library exports: EMSCAPE_VDB_ENTRY, which has the version in its name.
/// @param log  receives the library's messages
using VdbEntry = void(VdbFunctions& functions, const LogSink& log);

namespace vdb {
DenseVolume read(const std::filesystem::path& path, const std::string& grid_name);
std::vector<DenseVolume> describe(const std::filesystem::path& path);
void write(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes);
nano::Handle toNano(const DenseVolume& volume, const SourceLocation& location);
}  // namespace vdb

}  // namespace emscape::volume
