#include "base/files/json_writing.h"
#include "base/files/whole_file.h"
#include "volume/nvdb/nanovdb_grid.h"
#include "volume/nvdb/nvdb.h"
#include "volume/volume_json.h"

namespace emscape::volume {

void writeNvdb(const std::filesystem::path& path, const std::vector<const DenseVolume*>& volumes) {
  if (volumes.empty()) throw Error(ErrorCode::bad_input, {path.string()}, "no volume to write");
  std::vector<nano::Handle> handles;
  nlohmann::ordered_json sidecar;
  for (const DenseVolume* volume : volumes) {
    checkVolume(*volume, {path.string()});
    handles.push_back(toNano(*volume, {path.string()}));
    sidecar["volumes"].push_back(toJson(*volume, true));
  }
  writeWhole({{sidecarOf(path), [&](std::ostream& stream) { stream << dumpJson(sidecar, 2) << '\n'; }},
              {path, [&](std::ostream& stream) { nanovdb::io::writeGrids(stream, handles); }}});
}

}  // namespace emscape::volume
