#include "study/report/earlier_outputs.h"

#include "base/files/file_reading.h"
#include "base/files/json_reading.h"
#include "study/report/map_report.h"

namespace emscape::study {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

EarlierOutputs::EarlierOutputs(const fs::path& folder) : folder_(folder) {
  const fs::path record = folder / "study.json";
  if (!fs::is_regular_file(record)) return;
  try {
    readJson<Json>(readWholeText(record), record.string(), [&](const Json& json) {
      for (const Json& output : json.at("outputs")) output.at("file").get<std::string>();
      outputs_ = json.at("outputs");
    });
  } catch (const Error&) {
    return;  // is replaced
  }
}

void EarlierOutputs::removeExcept(const std::set<std::string>& written) const {
  for (const Json& output : outputs_) {
    const std::string name = output.at("file");
    const bool is_map = fs::path(name).parent_path() == "maps";
    if (!is_map || written.count(name) > 0) continue;
    try {
      if (digestJson(name, folder_ / name) == output) fs::remove(folder_ / name);
    } catch (const std::exception&) {
      continue;  // it is gone, or stays
    }
  }
}

}  // namespace emscape::study
