/// series.steps: the steps of a series whose files are complete. Internal to the module.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/files/appended_file.h"
#include "base/files/file_digest.h"
#include "emscape/playback/frames/field_series.h"

namespace emscape::playback {

/// A step whose files are complete.
struct StepRecord {
  struct File {
    std::string name;
    FileDigest digest;
  };
  int step = 0;                    ///< from 0; in the journal from 1
  std::vector<ValueRange> own;     ///< of the step's values, one per channel
  std::vector<ValueRange> stored;  ///< stored in the step's files
  std::vector<File> files;
};

/// A file of JSON lines that grows by one synced line per record; the last record of a step is valid. For one
/// thread.
class SeriesJournal {
 public:
  explicit SeriesJournal(const std::filesystem::path& folder);

  /// The records of a journal by step; none if there is no file. An incomplete last line, left by a killed
  /// process, is ignored.
  /// @param channels  number of ranges in each record
  /// @throws Error (bad_input) that names file and line for any other invalid line
  std::vector<std::optional<StepRecord>> read(int steps, std::size_t channels) const;

  /// The files that the readable lines of the journal list, for a series of any description.
  std::map<std::string, FileDigest> files() const;

  /// @throws Error (usage) for a link, and for a line that is not as append() wrote it
  void requireOwn() const;

  /// Adds a record. @throws Error (other)
  void append(const StepRecord& record);

 private:
  const std::filesystem::path file_;
  std::optional<AppendedFile> open_;  // from the first record on; has no incomplete line
};

}  // namespace emscape::playback
