/// The posts of one path of a sector, read by blocks when they are needed.
#pragma once

#include <vector>

#include "emfield/excess/block_cover.h"
#include "emfield/excess/sector_bounds.h"

namespace emscape::emfield {

/// A path of a sector.
struct PathToRead {
  double exact_distance_m;
  float distance_m;
  int before;  ///< last regular post before the receivers
  int blocks;
  float last_m;  ///< largest range of an obstacle
  float aside;   ///< in the sector, -1..1
};

/// Reads posts along the sector's chords, which are those of the path's profile within millimetres.
class PathPosts {
 public:
  /// Posts of a path in a block: crossings, of which there are rarely more, and regular posts near the
  /// emitter; of raised profiles elsewhere the beginning of a chord.
  static constexpr int kCrossings = 8, kOfBlock = BlockCover::kPosts;

  /// All must outlive this object.
  /// @param cover  by which profiles are raised; null: they are not
  PathPosts(const SectorObstacles& obstacles, const SectorTerrain& terrain, const BlockCover* cover,
            double sine_of_latitude);

  /// @param path  must outlive its use
  void begin(const PathToRead& path);
  const PathToRead& path() const { return *path_; }
  bool areRaised() const { return cover_ != nullptr; }

  /// Reads a block. Unused places are below everything.
  void read(int block);
  /// Whether clutter was added to a block that was read; adds it.
  bool isRaised(int block) const { return raised_for_[block] == number_; }
  void raise(int block);
  /// Of a block that was read. Heights are relative to the base.
  const float* range_m(int block) const { return range_m_.data() + block * kOfBlock; }
  const float* height_m(int block) const { return height_m_.data() + block * kOfBlock; }
  /// Bit i: the height of post i is an upper bound.
  unsigned doubtful(int block) const { return doubtful_[block]; }
  /// Number of the posts that a search has to visit, the first ones.
  int used(int block) const { return used_[block]; }

  /// A post for clutter (GroundPosts).
  struct ClutterPost {
    int block;
    float range_m, height_m;
    bool is_doubtful;  ///< the height is an upper bound
  };
  /// Calls visit(ClutterPost) for those of a block.
  template <class Visit>
  void eachClutterPost(int block, const Visit& visit) {
    const bool is_near =
        block == 0 || static_cast<double>(obstacles_.posts.first_m()[block]) <= kClutterFree_m;
    if (!is_near && obstacles_.posts.last_m()[block] < mirrored_m_) return;
    if (clutter_read_for_[block] != number_) {
      clutter_read_for_[block] = number_;
      readClutterPosts(block);
    }
    for (const ClutterPost& post : clutter_posts_) {
      if (post.block == block) visit(post);
    }
  }

  /// The path has a void, or a block of too many posts.
  bool isLeft() const { return is_left_; }
  void leave() { is_left_ = true; }

 private:
  /// The part of the path in a block, which is straight, within 0.1 mm.
  struct Part {
    const SectorChord& chord;
    Parabola<float> column, row;
    float begin, end;  ///< parts of the chord
    float first_m, length_m;

    float at(float range_m) const { return begin + (range_m - first_m) / length_m * (end - begin); }
  };
  Part partIn(int block) const;
  RasterLine lineIn(int block) const;
  void readClutterPosts(int block);
  float heightAt(const Part& part, float of_chord) const {
    return bilinearHeight(part.chord.corner_msl_m, terrain_.rowPosts(), part.column.at(of_chord),
                          part.row.at(of_chord)) -
           terrain_.base_msl_m();
  }
  bool isNear(int block) const { return block * SectorPosts::kBlock < obstacles_.ground.near_count; }

  const SectorObstacles& obstacles_;
  const SectorTerrain& terrain_;
  const BlockCover* cover_;
  float longest_chord_m_, longest_chord_beside_m_;
  const PathToRead* path_ = nullptr;
  int number_ = 0;        ///< of the path
  float chord_m_ = 0;     ///< length of the chords of its profile
  float mirrored_m_ = 0;  ///< first of the posts for clutter before the receivers
  float beside_m_ = 0;    ///< largest distance from its profile's path
  bool is_left_ = false;
  // Of the blocks that were read:
  std::vector<float> range_m_, height_m_;
  std::vector<int> read_for_, raised_for_, clutter_read_for_;  ///< numbers of paths
  std::vector<int> columns_, used_;                            ///< number of the posts on columns; of all
  std::vector<unsigned> doubtful_;
  std::vector<float> clutter_m_;  ///< ranges of the posts for clutter, once the first block needs them
  std::vector<ClutterPost> clutter_posts_;
};

}  // namespace emscape::emfield
