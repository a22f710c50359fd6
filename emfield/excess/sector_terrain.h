/// The ground below paths of nearly the same azimuth: chords for the posts of each path, and bounds of the
/// heights of all paths.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "emfield/excess/path_sectors.h"
#include "emfield/ground/ground_posts.h"
#include "emfield/ground/terrain_bounds.h"

namespace emscape::emfield {

/// The regular posts of a station, in blocks, and chords of whole blocks. A post stands for the ranges that
/// are nearer to it than to others, a block for those of its posts: the bounds of a block are made from the
/// ground at its posts in the middle of a sector, and paths read their crossings in it. Immutable once made.
class SectorPosts {
 public:
  static constexpr int kBlock = 8;  ///< posts
  /// Blocks that are bounded together.
  static constexpr int kGroup = 16;

  SectorPosts(const Station& station, const GroundPosts& ground);

  /// False if the posts are too far apart for chords of whole blocks.
  bool isUsable() const { return blocks_per_chord_ > 0; }
  int count() const { return static_cast<int>(range_m_.size()); }
  int blocks() const { return static_cast<int>(first_m_.size()); }
  int groups() const { return (blocks() + kGroup - 1) / kGroup; }
  int blocksPerChord() const { return blocks_per_chord_; }
  int chords() const { return (blocks() + blocks_per_chord_ - 1) / blocks_per_chord_; }
  /// Range of post i.
  const float* range_m() const { return range_m_.data(); }
  /// Position of post i in its chord: 0 at the chord's first post, 1 at that of the next chord.
  const float* part() const { return part_.data(); }
  /// The ranges that post i stands for.
  const float* nearest_m() const { return nearest_m_.data(); }
  const float* farthest_m() const { return farthest_m_.data(); }
  /// The ranges of the obstacles in each block, and their positions in its chord.
  const float* first_m() const { return first_m_.data(); }
  const float* last_m() const { return last_m_.data(); }
  const float* firstPart() const { return first_part_.data(); }
  const float* lastPart() const { return last_part_.data(); }
  /// Largest distance of such a range from a post of the block.
  const float* between_m() const { return between_m_.data(); }

  /// Index of a post in arrays of groups: first the first posts of a group's blocks, then the second
  /// ones, and so on, so that loops over the blocks are vector loops. The entry of the emitter's post is a
  /// copy of the first obstacle, and entries beyond the last post are copies of the last one.
  static int inGroups(int post) {
    const int block = post / kBlock;
    return (block / kGroup * kBlock + post % kBlock) * kGroup + block % kGroup;
  }
  std::size_t sizeInGroups() const { return static_cast<std::size_t>(groups()) * kGroup * kBlock; }
  /// The post of each entry of such an array.
  std::vector<int> postsInGroups() const;

 private:
  int blocks_per_chord_ = 0;
  std::vector<float> range_m_, part_, nearest_m_, farthest_m_;
  std::vector<float> first_m_, last_m_, first_part_, last_part_, between_m_;  ///< per block
};

/// A chord of all paths of a sector: the parabolas of positions in the raster, c[0] + s (c[1] + s c[2]), with
/// s = -1..1 across the sector.
struct SectorChord {
  Parabola<float> column[3], row[3];  ///< relative to the corner
  int corner_column, corner_row;
  const float* corner_msl_m;
};

/// The parabola of one path. @param of  SectorChord::column or row
inline Parabola<float> alongPath(const Parabola<float>* of, float aside) {
  Parabola<float> here;
  for (int n = 0; n < 3; ++n) here.c[n] = of[0].c[n] + aside * (of[1].c[n] + aside * of[2].c[n]);
  return here;
}

/// The terrain of one sector at a time; each thread has its own object.
class SectorTerrain {
 public:
  /// All must outlive this object.
  SectorTerrain(const Station& station, const GroundPosts& ground, const TerrainBounds& bounds,
                const SectorPosts& posts);

  /// Reads the posts of a sector.
  /// @param half_width_rad  > 0
  /// @param posts           that the farthest path needs, >= 1
  void read(const PathSectors::Azimuth& middle, double half_width_rad, int posts);

  /// Number of known posts: from the emitter to the edge of the finest raster, or to the first block that has
  /// a void in the middle or is wider than the bounds cover.
  int posts() const { return posts_read_; }
  /// Their blocks; the last one may be incomplete.
  int blocks() const { return (posts_read_ + SectorPosts::kBlock - 1) / SectorPosts::kBlock; }
  /// Height of the ground below the emitter.
  float base_msl_m() const { return base_msl_m_; }
  /// Heights of the regular posts in the middle of the sector, as SectorPosts::inGroups() orders them.
  const float* height_msl_m() const { return height_msl_m_.data(); }
  /// Per block: bound of the difference (m) between the height at the post that stands for a range and the
  /// heights at this range anywhere in the sector; infinity if there may be a void.
  const float* slack_m() const { return slack_m_.data(); }
  /// The same between heights at equal ranges.
  const float* acrossSlack_m() const { return across_slack_m_.data(); }
  /// Per block: upper bound of the clutter's height anywhere in the sector; 0 unless profiles are raised.
  const float* cover_m() const { return cover_m_.data(); }
  const SectorChord& chord(int index) const { return chords_[index]; }
  int rowPosts() const { return raster_->columns; }
  /// Reads the heights of the known posts of a block along one path.
  /// @param aside  of the path in the sector, -1..1
  void readBlock(int block, float aside, float* height_msl_m) const;

 private:
  int setChord(int index, int end_post);
  void spread(int index, int last_post);

  const Station& station_;
  const TerrainBounds& bounds_;
  const GroundPosts& ground_;
  const SectorPosts& posts_;
  const scenario::TerrainRaster* raster_;
  PathSectors::Azimuth azimuths_[3];  ///< low edge, middle, high edge
  FastDirect ends_[3];                ///< of the last chord, at these azimuths
  int posts_read_ = 0;
  float base_msl_m_ = 0;
  std::vector<SectorChord> chords_;
  std::vector<float> in_groups_part_;  ///< SectorPosts::part() in groups
  /// Per block: the parabolas of its chord in the middle of the sector, c[0], c[1] and c[2] of the columns,
  /// then of the rows; the part of the last post that is known; and the corner's index in the raster.
  std::vector<float> parabolas_[6], last_part_;
  std::vector<int> corner_;
  std::vector<float> height_msl_m_, slack_m_, across_slack_m_, cover_m_;
};

}  // namespace emscape::emfield
