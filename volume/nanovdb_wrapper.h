/// NanoVDB 10 under names of our own, because its headers and names changed in later versions: whoever uses
/// NanoVDB includes this and no header of NanoVDB. Compiles as CUDA too.
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
