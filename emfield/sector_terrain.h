/// The ground below paths of nearly the same azimuth: exact heights at the posts of any of them, and bounds
/// of the heights of all.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "emfield/ground_posts.h"
#include "emfield/path_sectors.h"
#include "emfield/terrain_bounds.h"

namespace emscape::emfield {

/// The posts of all paths from a station, in blocks, and chords of whole blocks. Immutable once made.
class SectorPosts {
 public:
  static constexpr int kBlock = 8;  ///< posts
  /// Blocks that are bounded together.
  static constexpr int kGroup = 16;

  SectorPosts(const Station& station, const GroundPosts& ground);

  /// False if the posts are too far apart for chords of whole blocks.
  bool isUsable() const { return blocks_per_chord_ > 0; }
  int blocks() const { return static_cast<int>(first_m_.size()); }
  int blocksPerChord() const { return blocks_per_chord_; }
  /// Range of post i.
  const float* range_m() const { return range_m_.data(); }
  /// Part of its chord at which post i is: 0 at the chord's first post, 1 at its last.
  const float* part() const { return part_.data(); }
  /// Ranges of the first and the last obstacle of each block: of its posts without the emitter's own.
  const float* first_m() const { return first_m_.data(); }
  const float* last_m() const { return last_m_.data(); }

 private:
  int blocks_per_chord_ = 0;
  std::vector<float> range_m_, part_, first_m_, last_m_;
};

/// A chord of all paths of a sector: the parabolas of positions in the raster, c[0] + s (c[1] + s c[2]) at
/// the part s of the sector's half width, -1..1.
struct SectorChord {
  Parabola<float> column[3], row[3];  ///< relative to the corner
  const float* corner_msl_m;
};

/// One sector at a time; each thread has its own.
class SectorTerrain {
 public:
  /// All must outlive this object.
  SectorTerrain(const Station& station, const GroundPosts& ground, const TerrainBounds& bounds,
                const SectorPosts& posts);

  /// Reads the posts of a sector.
  /// @param half_width_rad  > 0
  /// @param posts           that the farthest path needs, >= 1
  void read(const PathSectors::Azimuth& middle, double half_width_rad, int posts);

  /// Blocks that are known: from the emitter to the edge of the finest raster, or to the first that is at a
  /// void or wider than the bounds reach.
  int blocks() const { return blocks_; }
  /// Posts of these blocks; the last block may be known in part.
  int posts() const { return std::min(blocks_ * SectorPosts::kBlock, posts_read_); }
  /// Heights of the posts in the middle of the sector.
  const float* height_msl_m() const { return height_msl_m_.data(); }
  /// Per block: bound of the difference (m) between these and the heights at the same range anywhere in the
  /// sector.
  const float* slack_m() const { return slack_m_.data(); }
  const SectorChord& chordOf(int block) const { return chords_[block / posts_.blocksPerChord()]; }
  int rowPosts() const { return raster_->columns; }

 private:
  int setLongestChord(int first_post, int end_post);
  bool setChord(int first_post, int last_post);
  void readChord(int first_block, int end_block);

  const Station& station_;
  const TerrainBounds& bounds_;
  const GroundPosts& ground_;
  const SectorPosts& posts_;
  const scenario::TerrainRaster* raster_;
  PathSectors::Azimuth azimuths_[3];  ///< low edge, middle, high edge
  double half_width_rad_ = 0;
  int blocks_ = 0, posts_read_ = 0;
  std::vector<SectorChord> chords_;
  std::vector<float> height_msl_m_, slack_m_;
};

}  // namespace emscape::emfield
