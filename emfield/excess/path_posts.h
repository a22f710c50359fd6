/// The posts of several paths of a sector, side by side in vector lanes, read by blocks when they are needed.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "emfield/excess/block_cover.h"
#include "emfield/excess/sector_bounds.h"

namespace emscape::emfield {

/// Paths of a sector that are searched together. Lanes beyond the last path are copies of it.
struct PathLanes {
  double exact_distance_m[kPathLanes];
  float distance_m[kPathLanes];
  float last_m[kPathLanes];  ///< largest range of an obstacle
  float aside[kPathLanes];   ///< in the sector, -1..1
  int before[kPathLanes];    ///< last regular post before the receivers
  /// The path is to be read whole: it has a void, a block of too many posts, or a maximum that is not known
  /// exactly.
  int is_left[kPathLanes];
};

/// Reads posts along the sector's chords, which are those of the paths' profiles within millimetres.
class PathPosts {
 public:
  /// A post of each path. Heights are relative to the base; a path without this post has it at -infinity.
  struct Slot {
    float range_m[kPathLanes], height_m[kPathLanes];
    float column[kPathLanes], row[kPathLanes];  ///< position, relative to the chord's corner
    PostOn on;
  };

  /// All must outlive this object.
  /// @param cover  by which profiles are raised; null: they are not
  PathPosts(const SectorObstacles& obstacles, const SectorTerrain& terrain, const BlockCover* cover,
            double sine_of_latitude);

  /// @param paths  must outlive its use
  void begin(PathLanes& paths);
  const PathLanes& paths() const { return *paths_; }
  bool areRaised() const { return cover_ != nullptr; }

  /// Reads a block: its crossings, regular posts near the emitter and, of raised profiles elsewhere, the
  /// beginning of a chord.
  void read(int block);
  /// Reads those posts for clutter of the block that was read of which `isNeeded(ranges)` holds.
  /// @param visit(n)  is called after each was read
  template <class IsNeeded, class Visit>
  void readClutterPosts(int block, const IsNeeded& isNeeded, const Visit& visit);
  /// Of the block that was read.
  int count() const { return count_; }
  const Slot& operator[](int n) const { return slots_[n]; }
  /// Adds clutter to a post of some paths. @param lanes  bit i: of path i
  /// @return bit i: the height of path i is an upper bound
  unsigned raise(int n, unsigned lanes);
  /// The paths of these bits are to be read whole.
  void leave(unsigned lanes);

 private:
  /// Most crossings with columns and with rows in a block; rarely more than 6.
  static constexpr int kMaxCrossings = 12;
  static constexpr int kMaxSlots = 2 * kMaxCrossings + SectorPosts::kBlock + 1 + kMostClutterPosts;

  /// The paths in a block, which are straight there, within 0.1 mm.
  struct Part {
    float column[kPathLanes], row[kPathLanes], columns[kPathLanes], rows[kPathLanes];  ///< begin and length
    float first_m, length_m[kPathLanes];
    float whole_m, overlap;
    float begin, end;  ///< parts of the chord
  };
  void setPart(int block);
  template <bool kOnColumns>
  void readCrossings();
  void readAt(const float* at_m);
  void readClutterPost(int block, const float* at_m);
  void leaveUnknown(int block, int first);

  const SectorObstacles& obstacles_;
  const SectorTerrain& terrain_;
  const BlockCover* cover_;
  float longest_chord_m_, longest_chord_beside_m_;
  PathLanes* paths_ = nullptr;
  float chord_m_[kPathLanes];   ///< length of the chords of their profiles
  float beside_m_[kPathLanes];  ///< largest distance from their profiles' paths
  float mirrored_m_ = 0;        ///< first of the posts for clutter before the receivers, of all paths
  float nearest_end_m_ = 0;     ///< the smallest PathLanes::last_m
  struct ClutterPosts {
    float range_m[kPathLanes];  ///< infinite: none
    float nearest_m;            ///< of all paths
  };
  std::vector<ClutterPosts> clutter_posts_;  ///< GroundPosts::clutterPost_m()
  const SectorChord* chord_ = nullptr;       ///< of the block that was read
  Part part_;
  int count_ = 0;
  std::vector<Slot> slots_;
};

template <class IsNeeded, class Visit>
inline void PathPosts::readClutterPosts(int block, const IsNeeded& isNeeded, const Visit& visit) {
  const float* const last_m = obstacles_.posts.last_m();
  const bool is_near = block == 0 || static_cast<double>(obstacles_.posts.first_m()[block]) <= kClutterFree_m;
  if (!is_near && last_m[block] < mirrored_m_) return;
  const float before_m = block > 0 ? last_m[block - 1] : -HUGE_VALF, end_m = last_m[block];
  const float* const farthest_m = paths_->last_m;
  for (const ClutterPosts& posts : clutter_posts_) {
    if (end_m < nearest_end_m_ && posts.nearest_m > end_m) continue;
    float at_m[kPathLanes];
    int any = 0;
#pragma omp simd reduction(| : any)
    for (int l = 0; l < kPathLanes; ++l) {
      const float here_m = posts.range_m[l];
      const bool is_here = (here_m > before_m) & ((here_m <= end_m) | (end_m >= farthest_m[l]));
      at_m[l] = is_here ? here_m : HUGE_VALF;
      any |= at_m[l] < HUGE_VALF ? 1 : 0;
    }
    if (any == 0 || !isNeeded(at_m)) continue;
    readClutterPost(block, at_m);
    visit(count_ - 1);
  }
}

}  // namespace emscape::emfield
