/// Maps that an earlier run wrote into a folder.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace emscape::study {

/// The outputs that a folder's study.json lists, as digestJson() makes them; none if it is missing, is of
/// another subcommand of `emscape`, or has another form.
nlohmann::ordered_json outputsOf(const std::filesystem::path& folder, const std::string& command);

/// Removes those in the folder's maps/ that were not written again and still have the listed size and
/// checksum. @param written  names relative to the folder
void removeEarlierMaps(const std::filesystem::path& folder, const nlohmann::ordered_json& outputs,
                       const std::set<std::string>& written);

}  // namespace emscape::study
