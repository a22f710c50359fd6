#include <openvdb/io/Archive.h>

#include "base/whole_file.h"
#include "emscape/volume/vdb.h"
#include "volume/vdb_grid.h"

namespace emscape::volume {
namespace {

/// Writes to our own stream, which throws: OpenVDB's File does not notice a full disk. Unlike OpenVDB's
/// Stream it says where each grid lies, so that readers need not load them all.
class SeekableArchive : public openvdb::io::Archive {
 public:
  void writeTo(std::ostream& stream, const openvdb::GridCPtrVec& grids) const {
    openvdb::MetaMap metadata;
    metadata.insertMeta("creator", openvdb::StringMetadata("emscape " EMSCAPE_VERSION));
    Archive::write(stream, grids, /*seekable=*/true, metadata);
  }
};

}  // namespace

void writeVdb(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes) {
  openvdb::GridCPtrVec grids;
  for (const DenseVolume* volume : volumes) {
    checkVolume(*volume, {path.string()});
    grids.push_back(toOpenVdb(*volume, {path.string()}));
  }
  // Measured on 4 million voxels of a field: Blosc 9 MB in 0.2 s, none 16 MB in 0.03 s, ZIP 14 MB in 1.2 s.
  SeekableArchive archive;
  archive.setCompression(openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK);
  writeWhole(path, [&](std::ostream& stream) { archive.writeTo(stream, grids); });
}

}  // namespace emscape::volume
