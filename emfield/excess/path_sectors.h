/// Vertical columns by the direction of their paths from a station: columns of one narrow sector share the
/// search of the terrain.
#pragma once

#include <cstddef>
#include <vector>

#include "emfield/excess/fill_excess.h"

namespace emscape::emfield {

/// The path to a column.
struct SectorPath {
  double distance_m;   ///< along the ground
  double base_msl_m;   ///< height of the column's t = 0, of a surface
  float aside_rad;     ///< azimuth relative to the sector's middle
  float ground_msl_m;  ///< below the column
  int column;
};

/// Immutable once made.
class PathSectors {
 public:
  /// Number of sectors for some paths: none wider than a part of the post spacing. 0: the paths are too few
  /// for a search by sectors.
  static int countFor(const GroundPosts& ground, std::size_t paths);

  /// Columns that are left out or without ground are in no sector.
  /// @param count  number of sectors around the station, rounded up to a multiple of 4. They differ in width,
  /// but none is wider than 8 / count (rad)
  PathSectors(const Station& station, const ExcessGrid& grid, int count);

  int count() const { return 4 * per_quadrant_; }
  const SectorPath* begin(int sector) const { return paths_.data() + first_[sector]; }
  const SectorPath* end(int sector) const { return paths_.data() + first_[sector + 1]; }
  /// The largest distance in a sector; 0 without paths.
  double farthest_m(int sector) const;

  struct Azimuth {
    double sine, cosine;
  };
  Azimuth middle(int sector) const { return azimuthAt(sector, 0.5); }
  /// Upper bound of |aside_rad| in a sector.
  double halfWidth_rad(int sector) const;

 private:
  /// @param part  position in the sector, 0..1 with the azimuth
  Azimuth azimuthAt(int sector, double part) const;
  int sectorOf(double sin_azimuth, double cos_azimuth) const;

  int per_quadrant_;
  UnsetVector<SectorPath> paths_;  ///< by sector, then by column
  std::vector<std::size_t> first_;
};

}  // namespace emscape::emfield
