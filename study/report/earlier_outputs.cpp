#include "study/report/earlier_outputs.h"

#include "base/files/file_reading.h"
#include "base/files/json_reading.h"
#include "emscape/base/error.h"
#include "study/report/map_report.h"

namespace emscape::study {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json outputsOf(const fs::path& folder, const std::string& command) {
  const fs::path file = folder / "study.json";
  std::error_code is_unknown;
  if (!fs::is_regular_file(fs::symlink_status(file, is_unknown))) return Json::array();
  try {
    return readJson<Json>(readWholeText(file), file.string(), [&](const Json& json) {
      if (json.at("command") != command) return Json(Json::array());
      for (const Json& output : json.at("outputs"))
        static_cast<void>(output.at("file").get_ref<const std::string&>());
      return json.at("outputs");
    });
  } catch (const Error&) {
    return Json::array();  // is replaced
  }
}

void removeEarlierMaps(const fs::path& folder, const Json& outputs, const std::set<std::string>& written) {
  for (const Json& output : outputs) {
    const std::string name = output.at("file");
    if (fs::path(name).parent_path() != "maps" || written.count(name) > 0) continue;
    try {
      if (digestJson(name, folder / name) == output) fs::remove(folder / name);
    } catch (const std::exception&) {
      continue;  // it is gone, or stays
    }
  }
}

}  // namespace emscape::study
