#include "study/report/earlier_outputs.h"

#include <fmt/format.h>

#include <sstream>

#include "base/files/file_reading.h"
#include "base/files/json_reading.h"
#include "base/files/whole_file.h"
#include "emscape/base/error.h"
#include "study/report/map_report.h"

namespace emscape::study {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr const char* kUnfinished = "maps/.unfinished";
constexpr const char* kLabels = ".aux.xml";  ///< after the name of a GeoTIFF

bool isFile(const fs::path& path) {
  std::error_code is_unknown;
  return fs::symlink_status(path, is_unknown).type() == fs::file_type::regular;
}

bool isMap(const std::string& name) {
  return fs::path(name).parent_path() == "maps";
}

}  // namespace

EarlierOutputs::EarlierOutputs(const fs::path& folder) : folder_(folder) {
  // Each by itself: a record that another program has spoiled does not hide the other one.
  const auto read = [&](const char* name, const auto& take) {
    const fs::path file = folder / name;
    try {
      if (isFile(file)) take(readWholeText(file), file.string());
    } catch (const Error&) {
      return;  // is replaced
    }
  };
  read("study.json", [&](const std::string& text, const std::string& file) {
    readJson<Json>(text, file, [&](const Json& json) {
      for (const Json& output : json.at("outputs")) own_.insert(output.at("file").get<std::string>());
      outputs_ = json.at("outputs");
    });
  });
  read(kUnfinished, [&](const std::string& text, const std::string&) {
    std::istringstream lines(text);
    for (std::string name; std::getline(lines, name);) {
      if (isMap(name)) unfinished_.insert(name);
    }
  });
}

EarlierOutputs::~EarlierOutputs() {
  std::error_code is_unknown;
  for (const std::string& name : unfinished_) {
    if (fs::exists(fs::symlink_status(folder_ / name, is_unknown))) return;
  }
  if (!unfinished_.empty()) fs::remove(folder_ / kUnfinished, is_unknown);
}

bool EarlierOutputs::isOwn(const std::string& name) const {
  return own_.count(name) > 0 || unfinished_.count(name) > 0;
}

void EarlierOutputs::add(const std::string& name) {
  const std::string map = name.substr(0, name.rfind(kLabels));
  std::error_code is_unknown;
  if (!isOwn(name) && !isOwn(map) && fs::exists(fs::symlink_status(folder_ / name, is_unknown))) {
    throw Error(ErrorCode::usage,
                fmt::format("{}: would be replaced, and emscape did not write it; use another folder, or "
                            "move the file away",
                            (folder_ / name).string()));
  }
  if (unfinished_.insert(name).second) list();
}

void EarlierOutputs::list() const {
  writeWhole(folder_ / kUnfinished, [&](std::ostream& out) {
    for (const std::string& own : unfinished_) out << own << '\n';
  });
}

void EarlierOutputs::finish(const std::set<std::string>& written) {
  std::error_code is_missing;
  for (auto name = unfinished_.begin(); name != unfinished_.end();) {  // those of the earlier run
    const bool remains = written.count(*name) == 0 && isFile(folder_ / *name);
    name = remains ? std::next(name) : unfinished_.erase(name);
  }
  if (unfinished_.empty()) {
    fs::remove(folder_ / kUnfinished, is_missing);
  } else {
    list();
  }
  for (const Json& output : outputs_) {
    const std::string name = output.at("file");
    if (!isMap(name) || written.count(name) > 0) continue;
    try {
      if (digestJson(name, folder_ / name) == output) fs::remove(folder_ / name);
    } catch (const std::exception&) {
      continue;  // it is gone, or stays
    }
  }
}

}  // namespace emscape::study
