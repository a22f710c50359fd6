#include "scenario/file/file_kind.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "recording/read_recording.h"
#include "scenario/terrain/file_names.h"

namespace emscape::scenario {
namespace {

namespace fs = std::filesystem;

std::string firstBytesOf(const std::string& file) {
  std::string bytes(4096, '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  return bytes;
}

DocumentKind kindByKeys(const std::function<bool(const char*)>& has) {
  if (has("region") || has("platforms")) return DocumentKind::scenario;
  if (has("scenario") &&
      (has("measures") || has("variants") || has("sweep") || has("samples") || has("sites")))
    return DocumentKind::study;
  if (has("domain") && has("opacity")) return DocumentKind::transfer;
  if (has("recipe") && has("format_version")) return DocumentKind::series;
  if (has("camera") || has("open_panels")) return DocumentKind::view;
  if (has("type") && (has("features") || has("geometry"))) return DocumentKind::vectors;
  if (has("warnings") || has("emscape") || has("rows") || has("outputs")) return DocumentKind::result;
  return DocumentKind::unknown;
}

}  // namespace

std::string foreignFileText(const std::string& file) {
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return "";
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (ending == ".yaml" || ending == ".yml" || ending == ".json") return "";
  static const std::set<std::string> kVolumes{".vdb", ".nvdb", ".vti", ".vtu", ".pvd", ".raw", ".dat"};
  static const std::set<std::string> kAntennas{".msi", ".pln", ".adf", ".ant", ".pattern", ".az", ".el"};
  if (ending == ".png") return "is a picture (PNG), not a scenario";
  const std::vector<std::string>& recordings = interop::recordingEndings();
  const std::string bytes = firstBytesOf(file);
  if (std::find(recordings.begin(), recordings.end(), ending) != recordings.end() ||
      interop::isRecording(bytes))
    return "is a recording: `emscape import` makes a scenario of it";
  if (kVolumes.count(ending) != 0) return "is a volume: `render`, `view` and `info` read it";
  if (isElevationName(file))
    return "is an elevation file or another raster: a scenario names elevation files in 'terrain: {files: "
           "[...]}'";
  if (kAntennas.count(ending) != 0)
    return "is an antenna's file: a scenario names it in an emitter's 'antenna'";
  if (bytes.find('\0') != std::string::npos) return "is not text, as scenarios and studies are";
  return "";
}

DocumentKind documentKindOf(const document::DocumentNode& root) {
  if (root.kind != document::NodeKind::map) return DocumentKind::unknown;
  const auto valueOf = [](const document::DocumentNode& node, const char* key) {
    const auto found = std::find_if(node.entries.begin(), node.entries.end(),
                                    [&](const document::MapEntry& entry) { return entry.key == key; });
    return found == node.entries.end() ? nullptr : found->value.get();
  };
  const DocumentKind kind = kindByKeys([&](const char* key) { return valueOf(root, key) != nullptr; });
  const document::DocumentNode* const rows = valueOf(root, "emitters");
  const bool has_match =
      rows != nullptr && !rows->items.empty() && valueOf(*rows->items[0], "match") != nullptr;
  return kind == DocumentKind::unknown && has_match ? DocumentKind::emitters : kind;
}

DocumentKind documentKindOf(const nlohmann::json& root) {
  if (!root.is_object()) return DocumentKind::unknown;
  return kindByKeys([&](const char* key) { return root.contains(key); });
}

std::string otherDocumentText(DocumentKind kind, DocumentKind wanted) {
  if (kind == wanted || kind == DocumentKind::unknown) return "";
  const std::string is_not = wanted == DocumentKind::study ? ", not a study" : ", not a scenario";
  switch (kind) {
    case DocumentKind::scenario:
      return "a scenario" + is_not + ": a study names it with 'scenario: FILE'";
    case DocumentKind::study:
      return "a study" + is_not + ": `emscape study` computes it; it names its scenario";
    case DocumentKind::view:
      return "a view file" + is_not + ": `render` and `view` read it with --state";
    case DocumentKind::transfer:
      return "a transfer function" + is_not + ": `render` and `view` read it with --transfer";
    case DocumentKind::series:
      return "describes a series of volumes" + is_not + ": open its folder";
    case DocumentKind::emitters:
      return "an emitter database" + is_not + ": `emscape import` reads it with --emitters";
    case DocumentKind::vectors:
      return "GeoJSON" + is_not;
    default:
      return "a result of emscape" + is_not;
  }
}

}  // namespace emscape::scenario
