// The one unit that turns OpenVDB grids into NanoVDB's: it takes long to compile.
#include <nanovdb/util/OpenToNanoVDB.h>

#include "base/whole_file.h"
#include "volume/nanovdb_wrapper.h"
#include "volume/nvdb.h"
#include "volume/vdb_grid.h"
#include "volume/volume_json.h"

namespace emscape::volume {
namespace {

nano::Handle toNano(const DenseVolume& volume, const FilePlace& place) {
  const openvdb::GridBase::Ptr grid = toOpenVdb(volume, place);
  if (volume.info.categorical) {
    return nanovdb::OpenToNanoVDB<std::int32_t, std::int32_t>()(
        *openvdb::gridPtrCast<openvdb::Int32Grid>(grid));
  }
  return nanovdb::OpenToNanoVDB<float, float>()(*openvdb::gridPtrCast<openvdb::FloatGrid>(grid));
}

}  // namespace

void writeNvdb(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes) {
  if (volumes.empty()) throw Error(ErrorCode::bad_input, {path.string()}, "no volume to write");
  std::vector<nano::Handle> handles;
  nlohmann::ordered_json sidecar;
  for (const DenseVolume* volume : volumes) {
    checkVolume(*volume, {path.string()});
    handles.push_back(toNano(*volume, {path.string()}));
    sidecar["volumes"].push_back(toJson(*volume, true));
  }
  writeWhole({{sidecarOf(path), [&](std::ostream& stream) { stream << dumpJson(sidecar); }},
              {path, [&](std::ostream& stream) { nanovdb::io::writeGrids(stream, handles); }}});
}

}  // namespace emscape::volume
