/// One elevation file, read by GDAL: posts, heights in metres, voids.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/scenario/terrain/terrain.h"
#include "scenario/terrain/file_names.h"
#include "scenario/terrain/heights.h"
#include "scenario/terrain/plausibility.h"
#include "scenario/terrain/posts.h"

namespace emscape::scenario {

class Georeference;

/// What is known of a file before its heights are read.
struct TerrainFileHead {
  std::string name, format;
  SourceLocation location;
  TerrainFileKeys keys;
  std::vector<std::string>
      notes;              ///< for the user: bands left out, unit converted, positions transformed to WGS84
  HeightMeaning meaning;  ///< its warnings: what was assumed and may be wrong
  int columns = 0, rows = 0;
};

/// Posts are at the centres of the raster's pixels, as GDAL defines them, for pixel-is-area and for
/// pixel-is-point (GDAL shifts the corners of the latter by half a pixel when it opens them). Not safe to
/// share between threads.
class TerrainFile {
 public:
  /// Opens the file; reads no heights.
  /// @param location  of its name in the scenario; may be empty
  /// @throws Error (bad_input): no such file, not a raster, no georeference, heights of an unknown unit, keys
  /// that contradict the file
  TerrainFile(const ElevationSource& source, const SourceLocation& location, const TerrainFileKeys& keys);
  ~TerrainFile();

  const TerrainFileHead& head() const;
  const Georeference& georeference() const;
  std::string crs() const;

  /// Receives a row of heights (m above the file's datum; NaN for voids); rows are counted from the window's
  /// southern edge.
  using RowSink = std::function<void(long long row, const float* heights_m)>;
  /// Reads a window of the file, a strip of rows at a time; passes each row once. Packed files are unpacked
  /// once for opening and reading; see release(). Heights that are not on earth become voids.
  /// @return what the heights look like
  /// @throws Error (bad_input) if reading fails
  HeightTally read(const PostWindow& window, const RowSink& take) const;

  /// Frees the memory of a packed file; it is unpacked again if it is read again.
  void release() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::scenario
