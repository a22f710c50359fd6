/// Aliases of NanoVDB 10, whose headers and names changed in later versions: include this header, not those
/// of NanoVDB. Compiles also as CUDA.
#pragma once

#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/GridHandle.h>
#include <nanovdb/util/HostBuffer.h>
#include <nanovdb/util/IO.h>

namespace emscape::volume::nano {

using Handle = ::nanovdb::GridHandle<::nanovdb::HostBuffer>;
using Buffer = ::nanovdb::HostBuffer;
using FileHeader = ::nanovdb::io::Header;
using FileMetaData = ::nanovdb::io::MetaData;
using FileCodec = ::nanovdb::io::Codec;
using ::nanovdb::BBox;
using ::nanovdb::Coord;
using ::nanovdb::FloatGrid;
using ::nanovdb::GridData;
using ::nanovdb::GridType;
using ::nanovdb::NanoLeaf;
using ::nanovdb::NanoLower;
using ::nanovdb::NanoRoot;
using ::nanovdb::NanoUpper;
using ::nanovdb::Vec3d;
using TreeData = ::nanovdb::TreeData<3>;

constexpr std::uint64_t kMagic = NANOVDB_MAGIC_NUMBER;
constexpr int kMajorVersion = NANOVDB_MAJOR_VERSION_NUMBER;
constexpr std::uint64_t kAlignment = NANOVDB_DATA_ALIGNMENT;

}  // namespace emscape::volume::nano
