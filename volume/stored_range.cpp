#include "volume/stored_range.h"

#include <algorithm>
#include <cstring>

#include "base/files/file_patch.h"
#include "base/files/file_reading.h"
#include "base/files/json_writing.h"
#include "base/files/whole_file.h"
#include "volume/vdb_layout.h"
#include "volume/volume_json.h"

namespace emscape::volume {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

/// Changes the JSON sidecar of a volume file.
/// @param describe  finds the description of a quantity in the document; null if there is none
template <class Describe>
void setRangeInSidecar(const fs::path& path, const std::vector<StoredRange>& ranges,
                       const Describe& describe) {
  const fs::path sidecar = sidecarOf(path);
  const std::vector<std::uint8_t> bytes = readWhole(sidecar);
  Json document = parseJson({bytes.begin(), bytes.end()}, sidecar.string());
  for (const StoredRange& range : ranges) {
    Json* description = describe(document, range.quantity);
    if (description == nullptr || !description->contains("range_min"))
      failNoSuchQuantity(sidecar, range.quantity);
    (*description)["range_min"] = numberToJson(range.min);
    (*description)["range_max"] = numberToJson(range.max);
  }
  writeWhole(
      sidecar, [&](std::ostream& stream) { stream << dumpJson(document, 2) << '\n'; }, Replaces::any);
}

bool describes(const Json& json, const std::string& quantity) {
  return json.is_object() && json.contains("quantity") && json["quantity"] == quantity;
}

FilePatch floatPatch(const VdbMetadata& metadata, const char* key, float value, const fs::path& path) {
  const auto found = metadata.find(key);
  if (found == metadata.end() || found->second.type != "float" ||
      found->second.bytes.size() != sizeof(float)) {
    throw Error(ErrorCode::bad_input, {path.string()}, std::string("the grid has no ") + key);
  }
  std::string bytes(sizeof(float), '\0');
  std::memcpy(bytes.data(), &value, sizeof(float));
  return {found->second.offset, bytes};
}

}  // namespace

void failNoSuchQuantity(const fs::path& path, const std::string& quantity) {
  throw Error(ErrorCode::bad_input, {path.string()}, "states no range of a volume '" + quantity + "'");
}

void setRawRange(const fs::path& path, const std::vector<StoredRange>& ranges) {
  setRangeInSidecar(path, ranges, [](Json& document, const std::string& quantity) {
    return describes(document, quantity) ? &document : nullptr;
  });
}

void setNvdbRange(const fs::path& path, const std::vector<StoredRange>& ranges) {
  setRangeInSidecar(path, ranges, [](Json& document, const std::string& quantity) -> Json* {
    if (!document.is_object() || !document["volumes"].is_array()) return nullptr;
    for (Json& volume : document["volumes"]) {
      if (describes(volume, quantity)) return &volume;
    }
    return nullptr;
  });
}

void setVdbRange(const fs::path& path, const std::vector<StoredRange>& ranges) {
  const std::vector<std::uint8_t> bytes = readWhole(path);
  ByteReader reader(path.string(), bytes.data(), bytes.size());
  const VdbHeader header = readVdbHeader(reader);
  if (!header.has_offsets) reader.fail("the file has no offsets of its grids");
  std::vector<FilePatch> patches;
  for (int grid = 0; grid < header.grid_count; ++grid) {
    const VdbDescriptor descriptor = readVdbDescriptor(reader, header);
    reader.value<std::uint32_t>("compression");
    const VdbMetadata metadata = readVdbMetadata(reader);
    const auto range = std::find_if(ranges.begin(), ranges.end(), [&](const StoredRange& candidate) {
      return candidate.quantity == metaText(metadata, "emscape:quantity");
    });
    if (range != ranges.end()) {
      patches.push_back(floatPatch(metadata, "emscape:range_min", range->min, path));
      patches.push_back(floatPatch(metadata, "emscape:range_max", range->max, path));
    }
    reader.seek(descriptor.end, "end of a grid");
  }
  if (patches.size() != 2 * ranges.size()) {
    std::string names;
    for (const StoredRange& range : ranges) names += (names.empty() ? "" : ", ") + range.quantity;
    failNoSuchQuantity(path, names);
  }
  patchFile(path, patches);
}

}  // namespace emscape::volume
