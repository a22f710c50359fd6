/// Files that runs of emscape wrote into a folder of maps: what they may replace and remove.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

namespace emscape::study {

/// The outputs that a folder's study.json lists, and those of a run that did not reach its end:
/// maps/.unfinished lists them, a name a line, until they are written again or gone. None if these files are
/// missing or have another form.
class EarlierOutputs {
 public:
  explicit EarlierOutputs(const std::filesystem::path& folder);
  /// Removes the list of an unfinished run that left no output.
  ~EarlierOutputs();
  EarlierOutputs(const EarlierOutputs&) = delete;
  EarlierOutputs& operator=(const EarlierOutputs&) = delete;

  /// Before a map is written.
  /// @param name  relative to the folder
  /// @throws Error (usage) that names the file, if there is one that no run wrote; a GIS program's .aux.xml
  /// beside a map of ours counts as ours
  void add(const std::string& name);
  /// After study.json was written: removes those in the folder's maps/ that were not written again and still
  /// have the listed size and checksum.
  /// @param written  relative to the folder
  void finish(const std::set<std::string>& written);

 private:
  bool isOwn(const std::string& name) const;
  void list() const;

  std::filesystem::path folder_;
  nlohmann::ordered_json outputs_;    ///< as digestJson() makes them
  std::set<std::string> own_;         ///< names of all, relative to the folder
  std::set<std::string> unfinished_;  ///< of a run that did not reach its end, and of this one
};

}  // namespace emscape::study
