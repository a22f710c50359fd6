/// Land cover: classes of the ground, from rasters of codes.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/enum_names.h"
#include "emscape/base/error.h"

namespace emscape::scenario {

using emscape::toString;

struct GeoBox;
struct LandCoverView;  // scenario/terrain/view.h

/// Kind of land by its radar echo: by its gamma at 10 GHz.
/// @see M. W. Long, Radar Reflectivity of Land and Sea, 3rd ed. 2001; F. E. Nathanson, Radar Design
/// Principles, 2nd ed. 1999; as MATLAB's surfacegamma cites them
enum class LandKind {
  flatland,      ///< -20 dB
  farmland,      ///< -15 dB
  woods,         ///< -15 dB
  wooded_hills,  ///< -10 dB
  mountains,     ///< 0 dB
  urban          ///< 0 dB
};
constexpr auto namesOf(LandKind) {
  return std::array{"flatland", "farmland", "woods", "wooded_hills", "mountains", "urban"};
}

/// Class tables that come with the program.
enum class CoverTable { worldcover, corine, nlcd };
constexpr auto namesOf(CoverTable) {
  return std::array{"worldcover", "corine", "nlcd"};
}

/// Surface of a class. Water of a table that does not tell the sea from lakes is sea where the ground is at
/// most kMaxSea_m above mean sea level.
enum class CoverZone { land, water, sea };
constexpr auto namesOf(CoverZone) {
  return std::array{"land", "water", "sea"};
}

/// A row of a class table.
struct CoverClass {
  int code = 0;  ///< of the raster
  std::string name;
  double clutter_height_m = 0;  ///< of trees and buildings above the ground
  CoverZone zone = CoverZone::land;
  std::optional<LandKind> kind;  ///< for the radar's echo of land; none: as the radar's section says
  std::uint32_t color = 0;       ///< 0xAABBGGRR
};

/// What a scenario says of the land cover; without files: nothing.
struct LandCoverSpec {
  std::vector<std::string> files;  ///< as TerrainSpec::files; the first has priority
  std::vector<SourceLocation> locations;
  CoverTable classes = CoverTable::worldcover;
  std::string table;  ///< a CSV file in place of `classes`; empty: none

  bool isGiven() const { return !files.empty(); }
};

inline bool operator==(const LandCoverSpec& a, const LandCoverSpec& b) {
  return a.files == b.files && a.classes == b.classes && a.table == b.table;
}

/// The classes of a table: CSV with the columns code, name, clutter_height_m, zone (land, water, sea), land
/// (flatland, ..., or empty) and color (#rrggbb). Rows may share a name: they are one class in legends.
/// @throws Error (bad_input) naming file, line and column
std::vector<CoverClass> readCoverTable(const std::string& file);
/// A table of the program. @see docs/land-cover.md for the sources of its codes and heights
const std::vector<CoverClass>& coverTable(CoverTable table);

/// Classes within a box, on a raster of longitudes and latitudes. Immutable; safe to share between threads.
class LandCover {
 public:
  /// Highest sea (m above mean sea level) of water that may be a lake: tides, and errors of elevation files.
  static constexpr float kMaxSea_m = 2;

  /// @throws Error (bad_input) naming the file: no raster, no position, no class codes, no known code
  LandCover(const LandCoverSpec& spec, const GeoBox& box);
  ~LandCover();

  const std::vector<CoverClass>& classes() const;
  /// Cells of the box of each class, and without a known class.
  const std::vector<long long>& cellCounts() const;
  long long unknownCells() const;
  /// Distance (m) of the cells from north to south.
  double cell_m() const;
  /// Index in classes(); -1 where no class is known.
  int classAt(double latitude_deg, double longitude_deg) const;
  /// For loops, while this object lives.
  LandCoverView view() const;
  /// Unknown codes with their counts, thinned cells, parts without a class; each once.
  const std::vector<std::string>& warnings() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace emscape::scenario
