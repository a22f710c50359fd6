/// A folder of maps: their files, a report, and a record of the inputs.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "emscape/study/maps/map.h"
#include "study/maps/map_study.h"
#include "study/report/html_report.h"

namespace emscape::study {

/// A format of maps.
struct MapFormat {
  const char* name;         ///< "cog"
  const char* description;  ///< contents, and programs that open it; one line
};
const std::vector<MapFormat>& mapFormats();

/// A map that was written.
struct MapRecord {
  Map map;  ///< without its values
  MapSummary summary;
  std::vector<std::string> files;  ///< files of this map alone, relative to the folder
};

/// Writes DIR/maps/*, DIR/report.json, DIR/report.html and DIR/study.json. Each file is written atomically.
/// The same maps give the same bytes. The folder is locked against other processes. Outputs of an earlier run
/// that were not written again are removed at the end, if they are unchanged.
class MapFolder {
 public:
  /// @param formats  names of mapFormats()
  /// @throws Error (usage) for an unknown format; (other) naming the folder, if it cannot be created or
  /// another process writes it
  MapFolder(const std::filesystem::path& folder, MapStudy study, const std::vector<std::string>& formats);
  /// Removes incomplete files.
  ~MapFolder();
  MapFolder(const MapFolder&) = delete;
  MapFolder& operator=(const MapFolder&) = delete;

  /// Before the first map. @param names  fileNameOf() all maps
  /// @throws Error (usage) that names a file of theirs, or of all maps, that is not to be replaced
  void requireReplaceable(const std::vector<std::string>& names) const;
  /// Writes the files of one map, and adds it to the files that contain all maps.
  /// @throws Error (other) naming the file
  const MapRecord& add(const Map& map);

  /// Adds sections to report.html, below the table of the maps.
  using AddSections = std::function<void(HtmlReport&)>;
  /// Completes the files that contain all maps, and writes the reports.
  /// @param more  members for report.json beside the folder's own, as a JSON object; empty: none
  /// @throws Error (other) naming the file
  void finish(const std::vector<std::string>& warnings, const std::string& more = "",
              const AddSections& add = {});

  const std::vector<MapRecord>& records() const;
  /// Files that contain all maps, relative to the folder.
  std::vector<std::string> collections() const;
  /// The text of report.json; after finish().
  const std::string& reportJson() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace emscape::study
