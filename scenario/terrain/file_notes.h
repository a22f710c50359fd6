/// Notes and warnings on elevation files.
#pragma once

#include <string>
#include <vector>

#include "scenario/terrain/file.h"
#include "scenario/terrain/fill_values.h"

namespace emscape::scenario {

/// Notes on elevation files; a note on many files is made once.
class FileNotes {
 public:
  /// @param effect  on this file, for the first one
  void add(const std::string& file, const std::string& note, const std::string& effect = "");
  std::vector<std::string> texts() const;

 private:
  struct Note {
    std::string text, effect, first_file, last_file;
    int files;
  };
  std::vector<Note> notes_;
};

/// A fill value that a file does not declare.
std::string fillText(const FillValues::Found& fill);

/// FillValues::Result::is_partial.
inline constexpr const char* kPartlySearched =
    "has so many different heights below -500 m that only usual fill values (-9999, -10000, ...) were "
    "searched for; "
    "others would be ground. gdal_translate -a_nodata VALUE makes a copy that declares them";

/// What is assumed of a file's datum and unit, as nothing states it; empty: nothing is.
struct Assumption {
  std::string text;
  std::string effect;  ///< if the assumption is wrong, in the middle of the file; and how to state it
};
Assumption assumptionOf(const TerrainFile& file);

}  // namespace emscape::scenario
