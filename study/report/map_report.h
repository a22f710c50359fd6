/// The reports of a folder of maps, as text.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "study/report/html_report.h"
#include "study/report/map_folder.h"

namespace emscape::study {

/// report.json. @param more  as in MapFolder::finish()
std::string reportJsonOf(const MapStudy& study, const std::vector<MapRecord>& records,
                         const std::vector<std::string>& files, const std::vector<std::string>& warnings,
                         const std::string& more);

/// The terrain files in study.json: a list of digestJson().
nlohmann::ordered_json terrainJsonOf(const MapStudy& study);
/// study.json: inputs with their hashes, models with their accuracy, outputs.
/// @param terrain  terrainJsonOf(), from before the maps
/// @param folder  of the outputs  @param files  relative to it
std::string studyJsonOf(const MapStudy& study, const nlohmann::ordered_json& terrain,
                        const std::filesystem::path& folder, const std::vector<std::string>& files);

/// A file in study.json: {"file", "bytes", "crc32"}. @throws Error (bad_input) naming the file
nlohmann::ordered_json digestJson(const std::string& name, const std::filesystem::path& file);

/// The table of the maps, their areas and ranges.
ReportTable tableOf(const std::vector<MapRecord>& records);
/// A section on the models of a scenario's emitters and their accuracy.
void addModels(HtmlReport& report, const scenario::Scenario& scenario);
/// Sections on the inputs, the models and their accuracy, and the explanation of a pixel.
void addInputs(HtmlReport& report, const MapStudy& study, const std::vector<MapRecord>& records);

}  // namespace emscape::study
