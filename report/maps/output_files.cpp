#include "report/maps/output_files.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <string_view>
#include <system_error>

#include "base/files/descriptor.h"
#include "base/files/file_reading.h"
#include "emscape/base/error.h"
#include "emscape/scenario/file/scenario_file.h"
#include "emscape/study/maps/products.h"
#include "report/json.h"
#include "study/sweep/results/study_folder.h"

namespace emscape::report {
namespace {

namespace fs = std::filesystem;

bool isSame(const fs::path& a, const fs::path& b) {
  std::error_code failed;
  if (fs::exists(a, failed) && fs::exists(b, failed)) return fs::equivalent(a, b, failed);
  // An absolute path, because weakly_canonical() leaves a name in the working folder relative.
  return fs::weakly_canonical(fs::absolute(a, failed), failed) ==
         fs::weakly_canonical(fs::absolute(b, failed), failed);
}

/// True for a name that `coverage` and `compare` give: PRODUCT_..., or their own.
bool isNameOfMap(const std::string& name) {
  const auto begins = [&](const std::string& word) { return name.rfind(word, 0) == 0; };
  const auto& products = study::productTable();
  return begins("coverage.") || begins("compare.") ||
         std::any_of(products.begin(), products.end(),
                     [&](const auto& product) { return begins(product.name + std::string("_")); });
}

/// True for a file in the folder maps, or a symbolic link to one, that has the name of a map.
bool mayBeMapIn(const fs::path& maps, const fs::path& file) {
  std::error_code failed;
  const fs::path named = fs::absolute(file, failed), target = fs::weakly_canonical(named, failed);
  return (isSame(named.parent_path(), maps) && isNameOfMap(named.filename())) ||
         (isSame(target.parent_path(), maps) && isNameOfMap(target.filename()));
}

/// @param file  of scenario::filesOf()
std::string whatIs(const std::string& file, const scenario::Scenario& scenario) {
  return file == scenario.file ? "the scenario" : "a file that the scenario names";
}

[[noreturn]] void refuse(const NamedFile& output, const std::string& what) {
  throw Error(ErrorCode::usage, fmt::format("{}: {} is {}", output.name, output.file, what));
}

/// The beginning and the end of a file, where formats have the name of the program.
std::string endsOf(const fs::path& file) {
  constexpr std::streamoff kBegin = 1 << 20, kEnd = 4096;
  std::ifstream in(file, std::ios::binary);
  if (!in) return "not readable";
  std::string text(static_cast<std::size_t>(kBegin + kEnd), '\0');
  in.read(text.data(), kBegin);
  std::streamoff count = in.gcount();
  if (count == kBegin) {
    in.seekg(-kEnd, std::ios::end);
    in.read(text.data() + count, kEnd);
    count += in.gcount();
  }
  text.resize(static_cast<std::size_t>(count));
  return text;
}

/// True for a record of this program: with its version.
bool isOwnRecord(const Json& json) {
  return json.is_object() && json.contains("emscape") && json["emscape"].is_string() &&
         std::isdigit(static_cast<unsigned char>(json["emscape"].get<std::string>()[0])) != 0;
}

/// True for the sites of a study.
bool areOwnSites(const Json& json) {
  const auto isSite = [](const Json& feature) {
    if (!feature.is_object()) return false;
    const Json chosen = feature.value(Json::json_pointer("/properties/chosen"), Json("none"));
    return chosen.is_null() || chosen.is_number_integer();
  };
  return json.value("type", Json()) == "FeatureCollection" && json.contains("name") &&
         json.value("features", Json()).is_array() &&
         std::all_of(json["features"].begin(), json["features"].end(), isSite);
}

bool isOwnJson(const fs::path& file) {
  const Json json = Json::parse(readWholeText(file), nullptr, false);
  if (!json.is_object()) return false;
  return isOwnRecord(json) || areOwnSites(json) ||
         (json.contains("schema_version") && json.contains("transfer")) ||  // a view
         (json.contains("scenario") && json.contains("quantity") && json.contains("unit"));
}

/// True for a report that this program wrote.
bool isOwnReport(const fs::path& file) {
  const std::string text = readWholeText(file);
  const auto contains = [&](const char* part) { return text.find(part) != std::string::npos; };
  if (file.extension() == ".html")
    return contains("<html lang=\"en\">") && contains("<p class=\"subtitle\">");
  return isOwnRecord(Json::parse(text, nullptr, false));
}

/// True for the header of a table of `study`, `link`, `vertical` or `exposure`.
bool isOwnHeader(const std::string& line) {
  const auto begins = [&](std::string_view words) { return line.rfind(words, 0) == 0; };
  const auto ends = [&](std::string_view words) {
    return line.size() > words.size() && line.substr(line.size() - words.size()) == words;
  };
  // In the columns of a study paths of parameters, or units: "emitters.jammer.power_w,covered (km2)".
  return (begins("variant,name,") && line.find_first_of(".(") != std::string::npos) ||
         begins("kind,time_s,emitter,to,active,range_m,") ||
         begins("kind,azimuth_deg,line,range_m,slant_range_m,elevation_deg,") ||
         (begins("time_s,latitude_deg,longitude_deg,height_msl_m,height_agl_m,") && ends(",state,decides"));
}

/// True for a file of this program, by its content, and for an empty one.
bool isOwn(const fs::path& file) {
  const std::string text = endsOf(file);
  const auto begins = [&](std::string_view words) { return text.rfind(words, 0) == 0; };
  const auto contains = [&](std::string_view words) { return text.find(words) != std::string::npos; };
  if (text.empty()) return true;
  // Voxels alone, with a file beside them that says what they are.
  if (file.extension() == ".raw" || file.extension() == ".nvdb")
    return endsOf(file.string() + ".json").find("mscape") != std::string::npos;
  if (begins("\x89PNG")) return contains(std::string_view("Software\0Emscape", 16));  // as writePng()
  if (begins("{")) return isOwnJson(file);
  if (begins("<!DOCTYPE html>")) return isOwnReport(file);
  if (contains("<svg")) return contains("<!-- Emscape -->");
  if (begins("#!")) {
    return contains("\n#SBATCH --job-name=emscape-study\n") ||
           contains("\n#SBATCH --job-name=emscape-merge\n");
  }
  if (isOwnHeader(text.substr(0, text.find_first_of("\r\n")))) return true;
  // Films and volumes have the name between bytes that are no text, or in XML.
  return (contains(std::string_view("\0", 1)) || begins("<?xml") || begins("<VTKFile")) && contains("mscape");
}

}  // namespace

std::vector<NamedFile> outputsOf(const std::string& option, const std::vector<std::string>& files) {
  std::vector<NamedFile> outputs;
  for (const std::string& file : files) outputs.push_back({option, file});
  return outputs;
}

void checkOutputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs,
                  const std::vector<std::shared_ptr<const scenario::Scenario>>& scenarios,
                  bool replaces_any) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const NamedFile& output = outputs[i];
    if (output.file.empty()) continue;
    for (std::size_t other = 0; other < i; ++other) {
      if (!outputs[other].file.empty() && isSame(output.file, outputs[other].file))
        refuse(output, "also the output of " + outputs[other].name);
    }
    if (!fs::is_regular_file(output.file)) continue;
    for (const NamedFile& input : inputs) {
      if (!input.file.empty() && isSame(output.file, input.file)) refuse(output, input.name);
    }
    for (const auto& scenario : scenarios) {
      for (const std::string& file : scenario::filesOf(*scenario)) {
        if (!file.empty() && isSame(output.file, file)) refuse(output, whatIs(file, *scenario));
      }
    }
    if (!replaces_any && !isOwn(output.file))
      refuse(output, "a file that emscape did not write; give another name, or move it away first");
  }
}

void requireFolders(const std::vector<std::string>& files) {
  for (const std::string& file : files) {
    if (!file.empty()) openFolderOf(file);
  }
}

void checkStudyFolder(const fs::path& folder, const study::StudySpec& study, const std::string& option,
                      const std::vector<NamedFile>& others) {
  checkReports(folder, {"report.html"}, option);
  std::vector<NamedFile> outputs, inputs{{"the study", study.file}};
  for (const std::string& file : study.files) inputs.push_back({"a file that the study names", file});
  for (const std::string& name : study::StudyFolder::files(study))
    outputs.push_back({option, (folder / name).string()});
  outputs.insert(outputs.end(), others.begin(), others.end());
  checkOutputs(outputs, inputs, {study.base});
}

void checkReports(const fs::path& folder, const std::vector<std::string>& names, const std::string& option) {
  for (const std::string& name : names) {
    const fs::path file = folder / name;
    if (fs::exists(file) && !isOwnReport(file)) {
      throw Error(ErrorCode::usage,
                  fmt::format("{}: {} would be replaced, which is no report of emscape; use another folder",
                              option, file.string()));
    }
  }
}

void checkMapFolder(const fs::path& folder,
                    const std::vector<std::shared_ptr<const scenario::Scenario>>& scenarios,
                    const std::string& option) {
  checkReports(folder, {"study.json", "report.json", "report.html"}, option);
  const fs::path maps = folder / "maps";
  if (!fs::is_directory(maps)) return;
  for (const auto& scenario : scenarios) {
    for (const std::string& file : scenario::filesOf(*scenario)) {
      if (!file.empty() && mayBeMapIn(maps, file)) {
        throw Error(ErrorCode::usage,
                    fmt::format("{}: {} is {}, which a map could replace; use another folder", option, file,
                                whatIs(file, *scenario)));
      }
    }
  }
}

}  // namespace emscape::report
