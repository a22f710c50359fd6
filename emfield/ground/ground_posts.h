/// Terrain profiles from an emitter to the columns: the posts at which they read the ground.
///
/// The spacing of regular posts is half that of the elevation model, smaller near the emitter, and
/// independent of the grid. Profiles of delta-Bullington have posts where the path crosses the lines between
/// the posts of the elevation model: chord_crossings.h. The field, the jammers' paths and the budget of a
/// single path use the same posts.
#pragma once

#include <type_traits>
#include <vector>

#include "base/math/device_loop.h"
#include "emfield/ground/terrain_walk.h"
#include "emscape/base/host_device.h"
#include "emscape/scenario/terrain/terrain.h"
#include "propagation/column.h"

namespace emscape::emfield {

using propagation::ExcessScratch;
using propagation::TerrainProfile;

/// Distance (m) between the posts of the terrain; for a smooth earth (null) a length over which it deviates
/// from a plane by millimetres.
double postSpacing_m(const scenario::Terrain* terrain);

/// Ranges of posts from 0 to the first one not below farthest_m: first every few metres, because near the
/// emitter a few metres of ground mask a large angle, then proportional to the range, then equally spaced at
/// half the post spacing. Shorter lists are prefixes of longer ones.
std::vector<double> postRanges(double farthest_m, double post_spacing_m);

/// Distance (m) from the ends of a path within which its profile is that of the bare ground: the clutter
/// around the antennas is not an edge on the path. @see P.452-18, section 4.2, which has the same
constexpr double kClutterFree_m = 50;

/// True where clutter is added to a profile: from exactly kClutterFree_m of each end on.
EMSCAPE_HD inline bool isClutterAt(double range_m, double path_m) {
  constexpr double kFrom_m = kClutterFree_m - 1e-3;  // but for rounding
  return (range_m >= kFrom_m) & (path_m - range_m >= kFrom_m);
}

/// The highest posts of square tiles of the finest raster, by rows, south first. A tile has the posts on its
/// edges, too; with a void it is infinite.
struct HighestOfTiles {
  static constexpr int kShift = 3, kCells = 1 << kShift;  ///< cells between posts on a side

  const float* msl_m = nullptr;  ///< null: not known
  int columns = 0;
};

/// The ground as plain data, for loops on host and device.
struct GroundPosts {
  scenario::TerrainView terrain;
  bool is_smooth = true;  ///< a smooth earth at mean sea level; there is no terrain
  const double* ranges_m = nullptr;
  int range_count = 0;
  /// For profiles with posts at crossings (chord_crossings.h): number of the regular posts near the emitter.
  int near_count = 0;
  /// Chords with more crossings than this have regular posts; see maxCrossings().
  double crossings_per_m = 0;
  bool is_raised = false;  ///< profiles are raised by the clutter of the land cover; see raiseByClutter()
  /// Profiles have posts where clutter begins, and before the receivers as many as beyond the emitter, so
  /// that a path and the path back meet the same clutter; see clutterPost_m().
  bool has_clutter = false;
  int clutter_first = 0, clutter_end = 0;  ///< the regular posts that are mirrored for that
  HighestOfTiles tiles = {};

  /// Number of the posts for clutter of a long path.
  EMSCAPE_HD int clutterPosts() const { return has_clutter ? clutter_end - clutter_first + 2 : 0; }
  /// Range of one of them, ascending but for the first of a short path; not where clutter is not added: none.
  EMSCAPE_HD double clutterPost_m(int n, double path_m) const {
    const int mirrored = clutter_end - n;
    return n == 0 ? kClutterFree_m
                  : path_m - (mirrored >= clutter_first ? ranges_m[mirrored] : kClutterFree_m);
  }

  /// Largest number of crossings of a chord of some length that are read.
  EMSCAPE_HD int maxCrossings(double chord_m) const {
    constexpr int kOfShortChord = 8;
    return kOfShortChord + static_cast<int>(crossings_per_m * chord_m);
  }
  /// Index of the last post nearer than a range; 0 if there is none. Most posts are equally far apart: an
  /// estimate from the last one, then a few steps.
  EMSCAPE_HD int lastBefore(double range_m) const {
    if (range_count < 2 || !(range_m > ranges_m[1])) return 0;
    const int last = range_count - 1;
    const double steps = (ranges_m[last] - range_m) / (ranges_m[last] - ranges_m[last - 1]);
    int post = steps > 0 ? (steps < last ? last - static_cast<int>(steps) : 0) : last;
    while (post < last && ranges_m[post + 1] < range_m) ++post;
    while (ranges_m[post] >= range_m) --post;
    return post;
  }
};

/// Largest number of posts of a profile within the ranges of regular posts, with one at the receivers. Does
/// not read the ranges.
EMSCAPE_HD inline int maxPosts(const Station& station, const GroundPosts& ground, bool at_crossings) {
  const int regular = ground.range_count + 1 + ground.clutterPosts();
  if (!at_crossings || !(ground.crossings_per_m > 0)) return regular;
  // Of each chord either the crossings or the regular posts, which are at least 2/3 of the most crossings.
  const double farthest_m = 1.5 * ground.range_count / ground.crossings_per_m;
  const double chords = 1 + farthest_m / maxChord_m(std::fabs(station.geodesy.station.up.z));
  return regular + ground.range_count / 2 + static_cast<int>(chords) * (ground.maxCrossings(0) + 2);
}

/// The ground below an emitter's paths, in host memory. Pointers are valid as long as both arguments.
GroundPosts groundPosts(const scenario::Terrain* terrain, const std::vector<double>& ranges_m);

/// Height (m above mean sea level) that no post exceeds, of a terrain of one raster in which none is missing;
/// infinity of any other. Reads every post. The raster may be larger than Terrain::box().
float highestPost_m(const scenario::TerrainView& terrain);

/// HighestOfTiles::msl_m of a raster. Reads every post.
/// @param columns  set to HighestOfTiles::columns
std::vector<float> highestOfTiles(const scenario::TerrainRaster& raster, int& columns);

/// The tiles of HighestOfTiles along a chord.
class TilesOfChord {
 public:
  EMSCAPE_HD TilesOfChord(const GroundPosts& ground, const RasterChord& chord) : chord_(chord) {
    if (ground.tiles.msl_m == nullptr || chord.corner_msl_m == nullptr) return;
    const scenario::TerrainRaster& raster = ground.terrain.rasters[0];
    const long long corner = chord.corner_msl_m - raster.heights_msl_m;
    row_ = static_cast<int>(corner / raster.columns);
    column_ = static_cast<int>(corner - static_cast<long long>(row_) * raster.columns);
    tiles_ = ground.tiles;
  }
  EMSCAPE_HD bool areKnown() const { return tiles_.msl_m != nullptr; }
  /// A height that no post between two ranges exceeds; infinite beside a void and over more than 3 x 3 tiles.
  EMSCAPE_HD float highest_m(double from_m, double to_m) const {
    const auto from = static_cast<float>((from_m - chord_.begin_m) * chord_.per_m);
    const auto to = static_cast<float>((to_m - chord_.begin_m) * chord_.per_m);
    const Range columns = tilesAlong(chord_.column, column_, from, to);
    const Range rows = tilesAlong(chord_.row, row_, from, to);
    if (columns.last - columns.first > 2 || rows.last - rows.first > 2) return HUGE_VALF;
    float highest = -HUGE_VALF;
    for (int row = rows.first; row <= rows.last; ++row) {
      for (int column = columns.first; column <= columns.last; ++column)
        highest = fmaxf(highest, tiles_.msl_m[row * tiles_.columns + column]);
    }
    return highest;
  }

 private:
  struct Range {
    int first, last;
  };
  static EMSCAPE_HD Range tilesAlong(const Parabola<float>& line, int origin, float from, float to) {
    const float a = line.at(from), b = line.at(to);
    const float beside = fmaf(std::fabs(line.c[2]), (to - from) * (to - from) / 4, 0.001f);
    return {(origin + static_cast<int>(fminf(a, b) - beside)) >> HighestOfTiles::kShift,
            (origin + static_cast<int>(fmaxf(a, b) + beside)) >> HighestOfTiles::kShift};
  }

  const RasterChord& chord_;
  HighestOfTiles tiles_;
  int row_ = 0, column_ = 0;  ///< of the chord's corner
};

/// visitPosts() leaves out no posts.
struct NoPosts {
  EMSCAPE_HD bool operator()(int, int, float) const { return false; }
};

/// Calls visit(post, height above mean sea level (m)) for the first `count` posts toward a point, in their
/// order; NaN where the terrain is missing.
/// @param first  index of the first post
/// @param skips  skips(first post, last post, height (m)): true if those posts, none of which is higher, may
/// be left out. Threads of a warp leave them out together.
template <class Visit, class Skips = NoPosts>
EMSCAPE_HD void visitPosts(const Station& station, const GroundPosts& ground, const FastInverse& path,
                           int count, Visit visit, int first = 0, Skips skips = {}) {
  if (ground.is_smooth) {
    for (int i = first; i < count; ++i) visit(i, 0.0f);
    return;
  }
  constexpr int kAtOnce = 4;    // independent loads
  constexpr int kOfTiles = 16;  // regular posts are at half the spacing of the elevation model
  TerrainWalk walk(station, ground.terrain, path);
  const double* const ranges_m = ground.ranges_m;
  for (int i = first; i < count;) {
    const TerrainChord& chord = walk.chordAt(ranges_m[i]);
    const RasterChord in_raster = chord.in_raster;
    const int beyond = ground.lastBefore(walk.endOfChord_m(ranges_m[i])) + 1;
    const int end_of_chord = beyond <= i ? i + 1 : beyond < count ? beyond : count;
    const TilesOfChord tiles(ground, in_raster);
    int untried = 1;  // tiles to go through, after one that is not skipped
    while (i < end_of_chord) {
      int end = end_of_chord;
      if (!std::is_same_v<Skips, NoPosts> && tiles.areKnown()) {
        const int last = smaller(i + kOfTiles, end_of_chord) - 1;
        const bool is_needed = !skips(i, last, tiles.highest_m(ranges_m[i], ranges_m[last]));
        if (!isForAnyLane(is_needed)) {
          i = last + 1;
          untried = 1;
          continue;
        }
        end = smaller(i + untried * kOfTiles, end_of_chord);
        untried = smaller(2 * untried, 4);
      }
      while (i < end) {
        for (; in_raster.corner_msl_m != nullptr && i + kAtOnce <= end; i += kAtOnce) {
          float heights_msl_m[kAtOnce];
          bool is_known = true;
          EMSCAPE_UNROLL
          for (int n = 0; n < kAtOnce; ++n) {
            heights_msl_m[n] = in_raster.heightAt(ranges_m[i + n]);
            is_known = is_known && heights_msl_m[n] == heights_msl_m[n];
          }
          if (!is_known) break;
          EMSCAPE_UNROLL
          for (int n = 0; n < kAtOnce; ++n) visit(i + n, heights_msl_m[n]);
        }
        // Beside voids, outside the finest raster, and the last ones of a chord.
        for (const int next = i + kAtOnce < end ? i + kAtOnce : end; i < next; ++i) {
          visit(i, chord.heightAt(ground.terrain, ranges_m[i]));
        }
      }
    }
  }
}
/// The land cover at a range of a walk.
EMSCAPE_HD inline scenario::CoverValues coverAt(TerrainWalk& walk, const GroundPosts& ground,
                                                double range_m) {
  const TerrainChord& chord = walk.chordAt(range_m);
  const double part = (range_m - chord.in_raster.begin_m) * chord.in_raster.per_m;
  return ground.terrain.cover.valuesAt(chord.position.latitude_rad.at(part),
                                       chord.position.longitude_rad.at(part));
}

/// TerrainProfile::cover_m at a range of a walk.
EMSCAPE_HD inline float coverHeightAt(TerrainWalk& walk, const GroundPosts& ground, double range_m,
                                      float ground_msl_m) {
  const TerrainChord& chord = walk.chordAt(range_m);
  const double part = (range_m - chord.in_raster.begin_m) * chord.in_raster.per_m;
  return ground.terrain.coverAt(chord.position.latitude_rad.at(part), chord.position.longitude_rad.at(part),
                                ground_msl_m);
}
/// The same at ranges along a path.
EMSCAPE_HD inline void readCover(const Station& station, const GroundPosts& ground, const FastInverse& path,
                                 const double* ranges_m, const float* ground_msl_m, int count,
                                 float* cover_m) {
  TerrainWalk walk(station, ground.terrain, path);
  for (int i = 0; i < count; ++i) cover_m[i] = coverHeightAt(walk, ground, ranges_m[i], ground_msl_m[i]);
}

/// Reads the regular posts that are nearer than a point. Host and device.
struct PostReader {
  /// @return their number, with the emitter's
  EMSCAPE_HD int operator()(const Station& station, const GroundPosts& ground, const FastInverse& path,
                            double* range_m, float* height_msl_m) const {
    const int count = ground.lastBefore(path.distance_m) + 1;
    visitPosts(station, ground, path, count, [&](int i, float here) {
      range_m[i] = ground.ranges_m[i];
      height_msl_m[i] = here;
    });
    return count;
  }
  /// Reads TerrainProfile::cover_m.
  EMSCAPE_HD void readCover(const Station& station, const GroundPosts& ground, const FastInverse& path,
                            const double* range_m, const float* ground_msl_m, int count,
                            float* cover_m) const {
    emfield::readCover(station, ground, path, range_m, ground_msl_m, count, cover_m);
  }
};

/// Most posts for clutter of any path.
constexpr int kMostClutterPosts = 40;

/// The profile raised by the clutter's heights, except near its ends.
/// @param profile     with cover_m
/// @param raised_msl_m  memory for the heights; must outlive the result
EMSCAPE_HD inline TerrainProfile raiseByClutter(TerrainProfile profile, float* raised_msl_m) {
  const double path_m = profile.range_m[profile.count - 1];
  for (int i = 0; i < profile.count; ++i) {
    const bool is_between = isClutterAt(profile.range_m[i], path_m);
    const float raise_m = profile.cover_m[i] > 0 ? profile.cover_m[i] : 0.0f;  // not if it is NaN
    raised_msl_m[i] = profile.height_msl_m[i] + (is_between ? raise_m : 0.0f);
  }
  profile.bare_msl_m = profile.height_msl_m;
  profile.height_msl_m = raised_msl_m;
  return profile;
}

/// The height (m) of the ground at a point.
EMSCAPE_HD inline float groundAt(const Station& station, const GroundPosts& ground,
                                 const FastInverse& point) {
  if (ground.is_smooth) return 0;
  return TerrainWalk(station, ground.terrain, point).heightAt(point.distance_m);
}

/// Puts the posts for clutter into a profile. @return the new number of its posts
EMSCAPE_HD inline int addClutterPosts(const Station& station, const GroundPosts& ground,
                                      const FastInverse& path, int count, double* range_m,
                                      float* ground_msl_m) {
  double more_m[kMostClutterPosts];
  float here_msl_m[kMostClutterPosts];
  int more = 0;
  TerrainWalk walk(station, ground.terrain, path);
  for (int n = 0; n < ground.clutterPosts(); ++n) {
    const double at_m = ground.clutterPost_m(n, path.distance_m);
    if (!isClutterAt(at_m, path.distance_m)) continue;
    more_m[more] = at_m;
    here_msl_m[more++] = ground.is_smooth ? 0.0f : walk.heightAt(at_m);
  }
  const int all = count + more;
  for (int to = all - 1, from = count - 1; more > 0; --to) {
    const bool is_more = !(range_m[from] > more_m[more - 1]);
    range_m[to] = is_more ? more_m[more - 1] : range_m[from];
    ground_msl_m[to] = is_more ? here_msl_m[more - 1] : ground_msl_m[from];
    --(is_more ? more : from);
  }
  return all;
}

/// The profile to a point of the ground: the posts nearer than it, and the point itself.
/// @param read  PostReader, or an object with the same functions and results
template <class Reader>
EMSCAPE_HD TerrainProfile readProfile(const Station& station, const GroundPosts& ground,
                                      const FastInverse& point, float ground_msl_m,
                                      const ExcessScratch& scratch, const Reader& read) {
  const int nearer = read(station, ground, point, scratch.range_m, scratch.ground_msl_m);
  const int last = point.distance_m > 0 ? nearer : 0;
  if (last > 0) {
    scratch.range_m[last] = point.distance_m;
    scratch.ground_msl_m[last] = ground_msl_m;
  }
  int count = last + 1;
  if (ground.has_clutter && last > 0) {
    count = addClutterPosts(station, ground, point, count, scratch.range_m, scratch.ground_msl_m);
  }
  TerrainProfile profile{scratch.range_m, scratch.ground_msl_m, count};
  if (!ground.is_smooth && ground.terrain.hasCover()) {
    read.readCover(station, ground, point, scratch.range_m, scratch.ground_msl_m, count, scratch.cover_m);
    profile.cover_m = scratch.cover_m;
    if (ground.is_raised) return raiseByClutter(profile, scratch.raised_msl_m);
  }
  return profile;
}

}  // namespace emscape::emfield
