/// What a name of the scenario's elevation files stands for: a file, the files of a folder or of a pattern,
/// the members of a ZIP archive, the content of a .gz.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/scenario/terrain/terrain.h"

namespace emscape::scenario {

/// Files on the disk: those of a folder, or that match a pattern (* and ? in any part of the path), sorted by
/// name; any other name unchanged. Of a folder only files that look like heights by their ending, and no
/// masks that products bring beside them (such as N44W072_num.tif).
/// @throws Error (bad_input), without a location: an unreadable folder, no file
std::vector<std::string> elevationFilesOf(const std::string& name);

/// True if the ending is one of an elevation file, an archive of them included.
bool isElevationName(const std::string& name);

/// One elevation file, on the disk or packed.
struct ElevationSource {
  std::string file;         ///< on the disk
  std::string member = {};  ///< of the ZIP archive; the name of the content of a .gz; empty: the file itself

  /// For messages: the file, and the member.
  std::string name() const { return member.empty() ? file : file + "/" + member; }
  /// The name that tells the format and, for HGT, the position.
  const std::string& ownName() const { return member.empty() ? file : member; }
};

/// The elevation files in a file: itself, or those packed in it.
/// @throws Error (bad_input), without a location: an archive that cannot be read, or that has none
std::vector<ElevationSource> sourcesIn(const std::string& file);

/// The elevation files that an item of TerrainSpec::files stands for. @throws Error (bad_input) with its
/// location
std::vector<ElevationSource> sourcesOf(const TerrainSpec& spec, std::size_t item);
/// The keys of an item, with those of all files.
TerrainFileKeys keysOf(const TerrainSpec& spec, std::size_t item);

/// Largest content of a packed file (bytes): it is unpacked into memory.
constexpr std::size_t kMaxUnpackedBytes = std::size_t{4} << 30;

/// The content of a packed file. @throws Error (bad_input), without a location, if it cannot be unpacked
std::string unpackedContent(const ElevationSource& source, std::size_t max_bytes = kMaxUnpackedBytes);
/// The members of an archive in ascending order, without those that macOS adds; empty if it cannot be read.
/// @throws Error (bad_input), without a location, if there are too many
std::vector<std::string> membersOfZip(const std::string& file);
/// What an archive or packed file holds, for the error about one that is read only unpacked, with the remedy;
/// empty: it is none.
std::string packedFileText(const std::string& file);
/// The ending of a name, in lower case, with its point.
std::string lowerEnding(const std::string& name);

/// South-western corner of a tile of one degree.
struct TileCorner {
  int latitude_deg, longitude_deg;
};
/// From the first part of a name that reads like N38E052, in any case, also n38_e052.
std::optional<TileCorner> cornerInName(const std::string& name);

/// Files in GDAL's memory, below a folder of their own; removed by the destructor.
class MemoryFiles {
 public:
  MemoryFiles();
  ~MemoryFiles();
  MemoryFiles(const MemoryFiles&) = delete;
  MemoryFiles& operator=(const MemoryFiles&) = delete;

  /// Unpacks a packed file and those beside it in the archive that describe it (.hdr, .prj, .dbf, ...).
  /// @return the name for GDAL  @throws Error (bad_input), without a location, if it cannot be unpacked
  std::string unpack(const ElevationSource& source);
  /// Adds a file. @param name  without a folder  @return the name for GDAL
  std::string add(const std::string& name, std::string content);

  /// Names of the files, for GDAL's search of files that belong to one; ended by null.
  std::vector<const char*> siblings() const;

 private:
  std::string folder_;
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<std::string>> contents_;  ///< GDAL reads these bytes
};

}  // namespace emscape::scenario
